#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/input_files.h"
#include "core/base/ray.h"
#include "core/geometry/mesh.h"
#include "core/geometry/scene_objects.h"
#include "core/geometry/surfaces.h"
#include "core/scene/geometry_desc.h"

namespace uw {

/// How many objects and materials of a scene are numbered before those of an entry.
struct IdsBefore {
    std::uint32_t objects = 0, materials = 0;

    friend bool operator==(const IdsBefore&, const IdsBefore&) = default;
};

class MeshSource;  // core/geometry/mesh_reader.h

/// What a mesh file adds to the surfaces of a scene. Never changed once it is made.
struct FileSurfaces {
    struct Shared {
        std::shared_ptr<const MeshObject> object, of_glass;  // null: it has no such triangles
        Bounds bounds;                                       // in its own space
        std::vector<SharedMesh::Placement> placements;
    };
    std::vector<std::string> objects, materials;  // MeshFile's
    std::shared_ptr<const MeshObject> mesh;       // all meshes used once; null: none
    std::shared_ptr<const MeshObject> of_glass;   // likewise, of glass
    std::vector<std::optional<FileGlass>> glass;  // by material; none: it is opaque
    Bounds bounds;                                // of both
    std::vector<Shared> shared;
};

/// The surfaces of mesh files, kept from one scene to the next, so that each file is read once even
/// if objects move; of one that is animated, vertices are taken anew at each time. A file is read
/// again if it, or one that it names, has been replaced or written
/// since.
class MeshStore {
  public:
    /// Begins a scene: frees what none of the entries of its `geometry` needs, and what the scene
    /// before did not use.
    void keep_only(const std::vector<GeometryDesc>& geometry);

    /// The surfaces of the entry `desc`, that of a file, numbered after `before`. `reflectance`:
    /// its own, if any. Appends to `warnings` and throws as read_mesh does, whether it is read or
    /// not.
    std::shared_ptr<const FileSurfaces> load(const GeometryDesc& desc, const IdsBefore& before,
                                             const std::optional<Spectrum>& reflectance,
                                             std::vector<std::string>& warnings);

    /// The stamps of the files from which the last scene was read, as they were then.
    FileStamps files() const;

  private:
    /// What was read for `desc`, whose pose and time are left out if it moves.
    struct Kept {
        GeometryDesc desc;
        FileStamps files;                    // the file and those that it names
        std::shared_ptr<MeshSource> source;  // of animated files
        std::optional<double> time;          // of their contents:
        std::vector<std::string> warnings;
        std::shared_ptr<const MeshFile> file;          // of moving objects
        std::shared_ptr<const FileSurfaces> surfaces;  // of static ones,
        IdsBefore before;                              // with these ids
        bool is_used = true;                           // by the scene built last
    };
    /// Reads the contents of `kept`, which are those of `desc`.
    static std::shared_ptr<const FileSurfaces> read(Kept& kept, const GeometryDesc& desc,
                                                    const IdsBefore& before,
                                                    const std::optional<Spectrum>& reflectance,
                                                    std::vector<std::string>& warnings);

    std::vector<Kept> kept_;
};

/// Thousands of overlapping triangles, such as those of copies in nearly the same place: no
/// acceleration structure separates them, and each ray there tests all of them.
struct TriangleOverlap {
    double triangles = 0;         // estimated number
    Point3 where;                 // [m]
    std::uint32_t object_id = 0;  // of one of them
};

/// Finds a cube that contains triangles of its size whose area exceeds that of its face 4096 times.
/// Samples at most 65536 triangles.
std::optional<TriangleOverlap> find_overlap(const SceneObjects& objects);

/// Reads the mesh files of `geometry` and prepares everything for ray tracing, in world space [m].
/// Every shape honours its `world_from_object`. `wavelengths_nm`: one per band of the reflectances;
/// RGB colours in files are converted to bands by ReflectanceBands. A given `reflectance` replaces
/// a file's colours. Meshes that several objects of a file show are kept once (MeshFile::shared).
///
/// Every surface that is not of glass is opaque and diffuse on both sides: a single-sided glTF face
/// is shaded from behind as well, since light does not pass through it either. If any surface is of
/// glass, the result is a GlassSurfaces.
///
/// Appends the warnings of read_mesh to `warnings`. Throws InputError for invalid files, a singular
/// transform, or reflectances with a different band count; IoError; std::runtime_error if Embree
/// fails.
std::unique_ptr<Surfaces> build_surfaces(const std::vector<GeometryDesc>& geometry,
                                         const std::vector<double>& wavelengths_nm,
                                         std::vector<std::string>& warnings);

/// The same, but takes from `meshes` those that it contains; it then contains those of this scene.
std::unique_ptr<Surfaces> build_surfaces(const std::vector<GeometryDesc>& geometry,
                                         const std::vector<double>& wavelengths_nm,
                                         std::vector<std::string>& warnings, MeshStore& meshes);
}  // namespace uw
