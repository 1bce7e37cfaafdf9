#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace uw {

/// The text of a .gltf file, or of the first chunk of a .glb file. Throws IoError, InputError.
std::string read_gltf_text(const std::filesystem::path& file);

/// The JSON of a .gltf file, or of the first chunk of a .glb file (glTF 2.0, section 4.4). Throws
/// IoError, InputError (not glTF 2, truncated, nested too deeply), nlohmann's exceptions. Includes
/// nlohmann-json, so this header is for gltf_*.cpp only.
nlohmann::json load_gltf_json(const std::filesystem::path& file);

}  // namespace uw
