#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/geometry/mesh.h"

namespace uw {

/// Largest coordinate of a mesh in its file's units; products of three such numbers, which tracing
/// forms, are far from float's largest, 3e38.
inline constexpr double k_max_mesh_coordinate = 1e10;

/// How many triangles of a file were dropped, and why.
struct DroppedTriangles {
    std::uint64_t missing_corner = 0;  // an index past the last vertex
    std::uint64_t not_finite = 0;      // a corner is NaN, infinite or beyond k_max_mesh_coordinate
    std::uint64_t no_area = 0;

    /// One warning line per kind that occurred, each starting with `name`.
    void report(const std::string& name, std::vector<std::string>& warnings) const;
};

/// Removes the triangles that cannot be traced, in place and in order, and adds to `dropped`.
/// Normals that are not valid directions become zero ("flat").
void drop_bad_triangles(TriangleMesh& mesh, DroppedTriangles& dropped);

/// Largest texture coordinate, and number in a texture's transform: single precision does not tell
/// where in a texture a larger one lies.
inline constexpr double k_max_uv = 1e7;
/// Largest radiance of a surface [W m^-2 sr^-1], the limit of a lamp's brightness, and scale of a
/// normal map.
inline constexpr double k_max_emission = 1e12, k_max_normal_scale = 1e6;

/// How many values of a file were out of range, or not finite, and have been clamped.
struct ClampedValues {
    std::uint64_t uvs = 0;     // vertices; they became 0
    std::uint64_t colors = 0;  // vertices whose colour or alpha is not in 0..1
    std::uint64_t materials = 0;

    /// One warning line per kind that occurred, each starting with `name`.
    void report(const std::string& name, std::vector<std::string>& warnings) const;
};

/// Clamps the attributes of the vertices and materials of a mesh, from any file, to the ranges that
/// `mesh.h` states, in place, and adds to `clamped`. Tangents that are not finite become zero,
/// which is none.
void clamp_values(TriangleMesh& mesh, ClampedValues& clamped);

class GltfSource;  // core/geometry/gltf_reader.h

/// A mesh file that is read at several times of its animations: what a glTF file's first reading
/// has loaded of its bytes and textures is kept.
class MeshSource {
  public:
    MeshSource(std::filesystem::path file, const GltfUse& use)
        : file_(std::move(file)), use_(use) {}

    /// Reads it as read_mesh does, at the time of `use`, or at another one.
    MeshFile read(std::vector<std::string>& warnings) { return read(use_.time, warnings); }
    MeshFile read(const std::optional<double>& time, std::vector<std::string>& warnings);

  private:
    MeshFile read_any(const std::optional<double>& time, std::vector<std::string>& warnings);

    std::filesystem::path file_;
    GltfUse use_;
    std::shared_ptr<GltfSource> gltf_;  // null until it is read, and for other formats
};

/// Reads what a glTF (.gltf, .glb), OBJ, PLY or STL file shows, in the file's coordinates: no axis
/// or unit is converted. For glTF, the node hierarchy, materials (MeshMaterial), vertex colours,
/// normals and tangents are read, with the vertices of skins and morph targets where these have
/// them at the time of `use`; for OBJ, materials, vertex colours and normals; for PLY, vertex
/// colours and normals. A mesh without material has reflectance 0.5, or its vertex colours.
/// Polygons are split into triangles, degenerate triangles and those with invalid corners are
/// dropped, and no normals are generated.
///
/// Appends one line to `warnings` for everything dropped or ignored. Throws IoError if the file
/// cannot be opened, InputError if it is damaged, of another format, or has no triangles, unless
/// `use` takes something else from it. `use`: what is taken besides diffuse meshes, and is
/// therefore not reported as ignored.
MeshFile read_mesh(const std::filesystem::path& file, std::vector<std::string>& warnings,
                   const GltfUse& use = {});

/// The other files that read_mesh reads for a mesh file: buffers, textures and material libraries.
/// None for a file that cannot be read.
std::vector<std::filesystem::path> files_named_by_mesh(const std::filesystem::path& file);

}  // namespace uw
