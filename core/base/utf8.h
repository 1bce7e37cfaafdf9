#pragma once

#include <cstddef>
#include <string_view>

namespace uw {

/// The offset of the first byte that is not part of UTF-8 text (RFC 3629), or is a control
/// character other than tab, line feed and carriage return; the size of `bytes` if there is none.
std::size_t first_non_text(std::string_view bytes);

}  // namespace uw
