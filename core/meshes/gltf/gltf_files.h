#pragma once

#include <filesystem>
#include <vector>

namespace uw {

/// The external files that a glTF file refers to: buffers and images, in its order. None for a file
/// that cannot be read or is damaged; the actual reader reports what is wrong.
std::vector<std::filesystem::path> files_named_by_gltf(const std::filesystem::path& file);

}  // namespace uw
