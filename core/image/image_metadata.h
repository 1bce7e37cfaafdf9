#pragma once

#include <map>
#include <string>
#include <variant>

namespace uw {

/// Header metadata by name. Numbers are stored as 32-bit floats in EXR, as text in PNG.
using ImageMetadata = std::map<std::string, std::variant<std::string, double>>;

}  // namespace uw
