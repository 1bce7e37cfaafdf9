#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/spectrum.h"
#include "core/base/vector_math.h"
#include "core/geometry/glass_material.h"
#include "core/geometry/texture.h"

namespace uw {

/// Converts the RGB reflectance of mesh files into one value per wavelength band.
///
/// Three bands are red, green and blue in this order, whatever their wavelengths. Any other number
/// of bands is interpolated linearly in wavelength between blue at 450 nm, green at 540 nm and red
/// at 620 nm, and constant beyond these ends: RGB contains no more information.
class ReflectanceBands {
  public:
    /// `wavelengths_nm`: one per band, at most k_max_bands (else std::invalid_argument).
    explicit ReflectanceBands(const std::vector<double>& wavelengths_nm);

    int count() const { return static_cast<int>(weights_.size()); }
    /// Reflectance per band; entries past the band count are zero.
    Spectrum from_rgb(const Rgb& rgb) const;
    /// Its transpose: the derivatives of a number by R, G and B, from those by the bands.
    Rgb by_rgb(std::span<const double> by_band) const;

  private:
    std::vector<Rgb> weights_;  // per band: the weights of R, G, B; they sum to 1
};

/// A surface's material as given by a mesh file. Colours are linear; factors multiply their maps.
struct MeshMaterial {
    Rgb base_color{0.5, 0.5, 0.5};  // 0..1; also multiplied by vertex colours
    TextureUse base_map;
    bool double_sided = true;  // as in the file; surfaces are opaque from both sides
    /// The surface has holes where alpha (times that of base map and vertices) is below the cutoff;
    /// 0: no holes.
    double alpha = 1, alpha_cutoff = 0;
    Rgb emission{0, 0, 0};  // radiance [W m^-2 sr^-1], on both sides
    TextureUse emission_map;
    TextureUse normal_map;    // linear; x, y, z of the tangent frame as 0..1 for -1..1
    double normal_scale = 1;  // of its x and y
    // Metallic-roughness (glTF 2.0, appendix B); read for GltfUse::pbr only.
    double metallic = 0, roughness = 1;  // 0..1
    TextureUse metallic_roughness_map;   // linear; green roughness, blue metallic
    double ior = 1.5;                    // of the dielectric; 0: reflects everything
    std::optional<FileGlass> glass;      // it is transparent
    std::uint32_t number = 0;            // in MeshFile::materials, from 1; 0: none of the file's
};

/// Triangles with the attributes of their corners and faces. Inert.
struct TriangleMesh {
    std::vector<float> positions;          // x, y, z per vertex
    std::vector<std::uint32_t> triangles;  // three vertices each; all in range
    // Per vertex; empty if the file has none at all. A zero normal means "flat".
    std::vector<float> normals;             // x, y, z, unit
    std::array<std::vector<float>, 2> uvs;  // u, v; origin at the texture's top left, v down
    std::vector<float> colors;              // linear r, g, b, 0..1
    std::vector<float> alphas;              // 0..1
    /// x, y, z of the unit direction in which the normal map's u increases, and the sign of
    /// cross(normal, tangent) relative to the direction in which its v decreases; all zero if there
    /// is none.
    std::vector<float> tangents;
    std::vector<std::uint32_t> triangle_materials;  // per triangle; empty: all have material 0
    std::vector<MeshMaterial> materials{MeshMaterial{}};  // at least one
    std::vector<std::uint32_t>
        triangle_objects;  // per triangle, in MeshFile::objects; empty: all 0

    std::size_t vertex_count() const { return positions.size() / 3; }
    std::size_t triangle_count() const { return triangles.size() / 3; }
};

/// A mesh that several objects of a file show.
struct SharedMesh {
    struct Placement {
        Affine file_from_mesh;  // invertible
        std::uint32_t object = 0;
    };
    TriangleMesh mesh;  // in its own space; has no triangle_objects
    std::vector<Placement> placements;
};

/// The contents of a mesh file, in the file's own space [m]. Inert.
struct MeshFile {
    TriangleMesh mesh;               // all meshes used once, node hierarchy applied
    std::vector<SharedMesh> shared;  // the rest; none without triangles
    /// The names of what the file counts as an object, in its order: glTF nodes that show a mesh,
    /// OBJ's objects and groups, the whole of other files. Not unique.
    std::vector<std::string> objects;
    std::vector<std::string> materials;  // likewise, of all materials in the file

    bool has_triangles() const { return !mesh.triangles.empty() || !shared.empty(); }
};

/// What the scene uses of a glTF file besides triangles and diffuse materials.
struct GltfUse {
    /// Its camera or lamps, which import_gltf reads: the file need not show a mesh.
    bool camera_or_lamps = false;
    bool pbr = false;              // metallic, roughness and refractive index
    bool diffuse_meant = false;    // metal is shown as diffuse on request, and not reported
    std::optional<double> time{};  // of its animations [s]; none: its nodes are as they are written
};

/// Computes the tangents that a mesh with normal maps lacks (all zero) from the texture coordinates
/// of each triangle's normal map: at every vertex the mean over its triangles, weighted by their
/// angles and projected into the plane perpendicular to the normal, as MikkTSpace does, except that
/// vertices shared by mirrored halves of a texture take the side of the majority. Triangles without
/// vertex normals or with invalid coordinates keep zeros. Precondition: corners are in range.
void compute_tangents(TriangleMesh& mesh);

/// The directions in which the u of a triangle's normal map increases and its v decreases [any
/// length]; false if the coordinates are degenerate. `use` is the map.
struct UvAxes {
    Vector3 u_axis{0.0}, up_axis{0.0};
};
bool uv_axes(const TriangleMesh& mesh, const std::uint32_t* corners, const TextureUse& use,
             UvAxes& axes);

}  // namespace uw
