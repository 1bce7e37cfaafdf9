#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "core/base/ray.h"

namespace uw {

/// The JSON that commands print and write, with keys in the order they were added.
using Json = nlohmann::ordered_json;

/// A number, or null if it is not finite, which JSON cannot express.
Json number_json(double value);

/// A list of such numbers.
Json list_json(std::span<const double> values);

/// [x, y, z].
Json vector_json(const Vector3& v);
Json point_json(const Point3& p);

/// {"min": [x, y, z], "max": [x, y, z]}, or null where the box is empty.
Json bounds_json(const Bounds& bounds);

/// Indented, with a newline at the end. Names come from users' files and need not be valid UTF-8:
/// invalid bytes are replaced.
std::string json_text(const Json& json);
/// The same on one line, without a newline.
std::string json_line(const Json& json);

}  // namespace uw
