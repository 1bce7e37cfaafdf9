#pragma once

#include <optional>

namespace uw {

/// What the scene takes from a glTF file besides triangles and diffuse materials.
struct GltfUse {
    /// Its camera or lamps, which import_gltf reads: the file need not show a mesh.
    bool camera_or_lamps = false;
    bool pbr = false;              // metallic, roughness and refractive index
    bool diffuse_meant = false;    // metal is shown as diffuse on request, and not reported
    std::optional<double> time{};  // of its animations [s]; none: its nodes are as they are written
};

}  // namespace uw
