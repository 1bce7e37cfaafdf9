#pragma once

#include <string>
#include <string_view>

namespace uw {

/// The end of a message that refers to the documentation of causes, checks and hints. `section` is
/// a heading of docs/troubleshooting.md; scripts/check-docs looks for it there, so it is to be
/// written out where this is called.
inline std::string see_troubleshooting(std::string_view section) {
    std::string text = " (see \"";
    text.append(section).append("\" in docs/troubleshooting.md)");
    return text;
}

}  // namespace uw
