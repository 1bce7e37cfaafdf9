#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/meshes/gltf/gltf_document.h"

namespace uw {

/// The type of an accessor's numbers: its componentType (glTF 2.0, section 3.6.2.2).
enum : std::uint64_t {
    k_gltf_byte = 5120,
    k_gltf_unsigned_byte = 5121,
    k_gltf_short = 5122,
    k_gltf_unsigned_short = 5123,
    k_gltf_unsigned_int = 5125,
    k_gltf_float = 5126,
};

/// The bytes of a glTF document: buffers in the .glb itself, in files beside it, or embedded in its
/// text. For gltf_*.cpp only. The document has passed inspect_gltf, which checks sizes.
class GltfBytes {
  public:
    /// Refers to `document`. Buffers are loaded on first use.
    explicit GltfBytes(const GltfDocument& document)
        : document_(document), buffers_(document.list("buffers").size()) {}

    /// The bytes of the view that `parent` names under `key`. Throws IoError, InputError.
    std::span<const std::byte> view(const nlohmann::json& parent, const char* key);

    /// An accessor's values as consecutive floats, `width` per element, padded with zeros. Integers
    /// are normalised if the accessor specifies it.
    std::vector<float> floats(const nlohmann::json& accessor, std::size_t width);

    /// The vertex indices of an index accessor.
    std::vector<std::uint32_t> indices(const nlohmann::json& accessor);

  private:
    const std::vector<std::byte>& buffer(std::size_t index);

    const GltfDocument& document_;
    std::vector<std::vector<std::byte>> buffers_;  // empty until loaded
};

/// The bytes encoded in a "data:...;base64," URI. Throws InputError (through `document`).
std::vector<std::byte> decode_data_uri(const GltfDocument& document, const std::string& uri);

/// Numbers per element of an accessor's type; 0 for an unknown one.
std::size_t gltf_component_count(const std::string& type);
/// Bytes of a component type's number; 0 for an unknown one.
std::size_t gltf_component_size(std::uint64_t component_type);

}  // namespace uw
