#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/files/input_files.h"
#include "core/meshes/mesh_file.h"
#include "core/scene/geometry_desc.h"
#include "core/surfaces/scene_objects.h"

namespace uw {

/// How many objects and materials of a scene are numbered before those of an entry.
struct IdsBefore {
    std::uint32_t objects = 0, materials = 0;

    friend bool operator==(const IdsBefore&, const IdsBefore&) = default;
};

/// What a mesh file adds to the surfaces of a scene. Never changed once it is made.
struct FileSurfaces {
    struct Shared {
        std::shared_ptr<const MeshObject> object;
        Bounds bounds;  // in its own space
        std::vector<SharedMesh::Placement> placements;
    };
    std::vector<std::string> objects, materials;  // MeshFile's
    std::shared_ptr<const MeshObject> mesh;       // all that is there once; null: nothing
    Bounds bounds;                                // of `mesh`
    std::vector<Shared> shared;
};

/// The surfaces of mesh files, kept from one scene to the next: where some objects move, the files
/// of all others are read once, and those of the moving ones, too. A file that has been replaced or
/// written since, or one that it names, is read again.
class MeshStore {
  public:
    /// Begins a scene: frees what none of the entries of its `geometry` is, and what the scene
    /// before had no use for.
    void keep_only(const std::vector<GeometryDesc>& geometry);

    /// What the entry `desc`, that of a file, adds behind `before`. `reflectance`: its own, if any.
    /// Appends to `warnings` and throws as read_mesh, whether it is read or not.
    std::shared_ptr<const FileSurfaces> load(const GeometryDesc& desc, const IdsBefore& before,
                                             const std::optional<Spectrum>& reflectance,
                                             std::vector<std::string>& warnings);

  private:
    using Stamps = std::vector<std::pair<std::filesystem::path, std::optional<FileStamp>>>;

    /// As it was read for `desc`, whose pose is left out if it moves.
    struct Kept {
        GeometryDesc desc;
        Stamps stamps;  // of the file and those that it names
        std::vector<std::string> warnings;
        std::shared_ptr<const MeshFile> file;          // of what moves
        std::shared_ptr<const FileSurfaces> surfaces;  // of what does not,
        IdsBefore before;                              // with these ids
        bool is_used = true;                           // by the scene built last
    };
    static Stamps stamps_of(const GeometryDesc& desc);
    static bool is_unchanged(const Kept& kept);

    std::vector<Kept> kept_;
};

}  // namespace uw
