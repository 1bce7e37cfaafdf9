#pragma once

namespace uw {

/// What of a glTF file the scene takes beside triangles and the look of diffuse surfaces.
struct GltfUse {
    bool camera = false, lamps = false;  // read by import_gltf, not with the mesh
    bool pbr = false;                    // metallic, roughness and refractive index
};

}  // namespace uw
