#pragma once

namespace uw {

/// What the scene takes from a glTF file besides triangles and diffuse materials.
struct GltfUse {
    bool camera = false, lamps = false;  // read by import_gltf, not with the mesh
    bool pbr = false;                    // metallic, roughness and refractive index
};

}  // namespace uw
