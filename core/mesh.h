#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/rgb.h"
#include "core/texture.h"

namespace uw {

/// What a mesh file says of a surface's colour.
struct MeshMaterial {
    Rgb base_color{0.5, 0.5, 0.5};  // linear, 0..1; multiplied by texture and vertex colours
    std::shared_ptr<const Texture> texture;  // may be null
    TextureLookup lookup;
    bool double_sided = true;  // as the file has it; surfaces are opaque from both sides
};

/// The triangles of one mesh file, in the file's own space [m], node hierarchy applied. Inert.
struct TriangleMesh {
    std::vector<float> positions;          // x, y, z per vertex
    std::vector<std::uint32_t> triangles;  // three vertices each; all in range
    // Per vertex, and empty when the file has none at all. A zero normal stands for "flat".
    std::vector<float> normals;  // x, y, z, unit
    std::vector<float> uvs;      // u, v; origin at the top left of the texture, v down
    std::vector<float> colors;   // linear r, g, b, 0..1
    std::vector<std::uint32_t> triangle_materials;  // per triangle; empty: all have material 0
    std::vector<MeshMaterial> materials{MeshMaterial{}};  // at least one

    std::size_t vertex_count() const { return positions.size() / 3; }
    std::size_t triangle_count() const { return triangles.size() / 3; }
};

}  // namespace uw
