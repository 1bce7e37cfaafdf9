#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/affine.h"
#include "core/meshes/gltf/gltf_bytes.h"
#include "core/meshes/gltf/gltf_materials.h"
#include "core/meshes/mesh.h"

namespace uw {

/// One node's use of one primitive of a mesh; for gltf_*.cpp only.
struct GltfPlacement {
    const nlohmann::json* mesh = nullptr;
    const nlohmann::json* primitive = nullptr;
    Affine file_from_mesh;
    std::size_t material = 0;  // in the file's list; its size: none
    std::uint32_t object = 0;  // in MeshFile::objects
};

/// Joins primitives into one mesh, placed, and with those of the file's materials that they use.
/// `document` has passed inspect_gltf. For gltf_*.cpp only.
class GltfJoiner {
  public:
    /// Refers to all of them.
    GltfJoiner(const GltfDocument& document, GltfBytes& bytes, GltfMaterials& materials)
        : document_(document), bytes_(bytes), materials_(materials) {}

    /// Throws InputError for coordinates that are missing, and as GltfMaterials::read.
    TriangleMesh join(const std::vector<GltfPlacement>& placements);

  private:
    const GltfDocument& document_;
    GltfBytes& bytes_;
    GltfMaterials& materials_;
};

}  // namespace uw
