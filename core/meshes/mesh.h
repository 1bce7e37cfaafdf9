#pragma once

#include <array>
#include <cstdint>

#include <vector>

#include "core/colour/rgb.h"
#include "core/meshes/texture.h"

namespace uw {

/// A surface's material as given by a mesh file. Colours are linear; factors multiply their maps.
struct MeshMaterial {
    Rgb base_color{0.5, 0.5, 0.5};  // 0..1; also multiplied by vertex colours
    TextureUse base_map;
    bool double_sided = true;  // as in the file; surfaces are opaque from both sides
    /// There is a hole where alpha (times that of base map and vertices) is below the cutoff; 0:
    /// nowhere.
    double alpha = 1, alpha_cutoff = 0;
    Rgb emission{0, 0, 0};  // radiance [W m^-2 sr^-1], on both sides
    TextureUse emission_map;
    TextureUse normal_map;    // linear; x, y, z of the tangent frame as 0..1 for -1..1
    double normal_scale = 1;  // of its x and y
    // Metallic-roughness (glTF 2.0, appendix B); read for GltfUse::pbr only.
    double metallic = 0, roughness = 1;  // 0..1
    TextureUse metallic_roughness_map;   // linear; green roughness, blue metallic
    double ior = 1.5;                    // of the dielectric; 0: reflects everything
    std::uint32_t number = 0;            // in MeshFile::materials, from 1; 0: none of the file's
};

/// Triangles with what their corners and faces carry. Inert.
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

}  // namespace uw
