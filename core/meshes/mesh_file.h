#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/affine.h"
#include "core/meshes/mesh.h"

namespace uw {

/// A mesh that several objects of a file show.
struct SharedMesh {
    struct Placement {
        Affine file_from_mesh;  // invertible
        std::uint32_t object = 0;
    };
    TriangleMesh mesh;  // in its own space; has no triangle_objects
    std::vector<Placement> placements;
};

/// What a mesh file shows, in the file's own space [m]. Inert.
struct MeshFile {
    TriangleMesh mesh;               // all that is there once, node hierarchy applied
    std::vector<SharedMesh> shared;  // the rest; none without triangles
    /// The names of what the file counts as an object, in its order: glTF nodes that show a mesh,
    /// OBJ's objects and groups, the whole of other files. Not unique.
    std::vector<std::string> objects;
    std::vector<std::string> materials;  // likewise, of all materials in the file

    bool has_triangles() const { return !mesh.triangles.empty() || !shared.empty(); }
};

}  // namespace uw
