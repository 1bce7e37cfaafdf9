#pragma once

#include <filesystem>
#include <string>

namespace uw {

/// The file that a relative URI in `gltf_file` refers to (percent-decoded).
std::filesystem::path gltf_uri_path(const std::filesystem::path& gltf_file, const std::string& uri);

}  // namespace uw
