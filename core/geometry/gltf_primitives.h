#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <tuple>
#include <vector>

#include "core/base/vector_math.h"
#include "core/geometry/gltf_deformation.h"
#include "core/geometry/gltf_document.h"
#include "core/geometry/mesh.h"

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
    std::optional<FileGlass> read_glass(const nlohmann::json& material, const Rgb& colour) const;
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

/// One node's use of one primitive of a mesh; for gltf_*.cpp only.
struct GltfPlacement {
    const nlohmann::json* mesh = nullptr;
    const nlohmann::json* primitive = nullptr;
    Affine file_from_mesh;
    std::size_t material = 0;                      // in the file's list; its size: none
    std::uint32_t object = 0;                      // in MeshFile::objects
    const GltfDeformation* deformation = nullptr;  // null: it is rigid
};

/// Joins primitives into one mesh, placed, and with those of the file's materials that they use.
/// `document` has passed inspect_gltf. For gltf_*.cpp only.
class GltfJoiner {
  public:
    /// Refers to all of them.
    GltfJoiner(const GltfDocument& document, GltfBytes& bytes, GltfMaterials& materials)
        : document_(document), bytes_(bytes), materials_(materials) {}

    /// Throws InputError for coordinates that are missing, and as GltfMaterials::read and
    /// DeformedPrimitive.
    TriangleMesh join(const std::vector<GltfPlacement>& placements);

    /// Those of all meshes so far.
    const NormalisedWeights& normalised() const { return normalised_; }

  private:
    const GltfDocument& document_;
    GltfBytes& bytes_;
    GltfMaterials& materials_;
    NormalisedWeights normalised_;
};

/// The vertices of a placement that deforms. For gltf_*.cpp only. Refers to all.
DeformedPrimitive deformed(const GltfDocument& document, GltfBytes& bytes,
                           const GltfPlacement& placement);

}  // namespace uw
