#pragma once

#include <filesystem>
#include <optional>

#include "core/scene/geometry_desc.h"

namespace uw {

/// From the first to the last key of the animations that move nodes of a glTF file; none if there
/// are none. A file that cannot be read has none: whoever loads it says what is wrong with it.
std::optional<TimeRange> gltf_time_range(const std::filesystem::path& file);

}  // namespace uw
