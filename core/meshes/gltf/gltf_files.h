#pragma once

#include <filesystem>
#include <vector>

namespace uw {

/// The files that a glTF file names beside itself: buffers and pictures, in its order. None for a
/// file that cannot be read or is broken; whoever reads it for good says what is wrong.
std::vector<std::filesystem::path> files_named_by_gltf(const std::filesystem::path& file);

}  // namespace uw
