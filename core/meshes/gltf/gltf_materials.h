#pragma once

#include <map>
#include <memory>
#include <tuple>
#include <vector>

#include "core/meshes/gltf/gltf_bytes.h"
#include "core/meshes/gltf/gltf_use.h"
#include "core/meshes/mesh.h"

namespace uw {

/// Reads the materials of a glTF document, and each of their images once; for gltf_*.cpp only.
class GltfMaterials {
  public:
    /// Refers to both.
    GltfMaterials(const GltfDocument& document, GltfBytes& bytes, const GltfUse& use)
        : document_(document), bytes_(bytes), use_(use) {}

    /// The material with that index in the file. Throws InputError or IoError for images that
    /// cannot be read, and for texture coordinates beyond the second set.
    MeshMaterial read(std::size_t index);

  private:
    TextureUse read_texture(const nlohmann::json& parent, const char* key, TextureEncoding encoding,
                            bool keep_alpha = false);
    std::shared_ptr<const Texture> picture(std::size_t image, TextureEncoding encoding,
                                           bool keep_alpha);

    const GltfDocument& document_;
    GltfBytes& bytes_;
    GltfUse use_;
    std::map<std::tuple<std::size_t, TextureEncoding, bool>, std::shared_ptr<const Texture>>
        pictures_;
};

}  // namespace uw
