#pragma once

#include <string>

namespace uw {

/// `text` as a string of JSON, with its quotes. Bytes that are not valid UTF-8 are replaced, as by
/// json_text. It has a header of its own because that of the JSON library takes seconds to compile.
std::string json_string(const std::string& text);

}  // namespace uw
