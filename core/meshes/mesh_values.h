#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/meshes/mesh.h"

namespace uw {

/// Largest texture coordinate, and number in a texture's transform: single precision does not tell
/// where in a texture a larger one lies.
inline constexpr double k_max_uv = 1e7;
/// Largest radiance of a surface [W m^-2 sr^-1], the limit of a lamp's brightness, and scale of a
/// normal map.
inline constexpr double k_max_emission = 1e12, k_max_normal_scale = 1e6;

/// How many values of a file were out of range, or not finite, and brought into it.
struct ClampedValues {
    std::uint64_t uvs = 0;     // vertices; they became 0
    std::uint64_t colors = 0;  // vertices whose colour or alpha is not in 0..1
    std::uint64_t materials = 0;

    /// One warning line per kind that occurred, each starting with `name`.
    void report(const std::string& name, std::vector<std::string>& warnings) const;
};

/// Brings what the vertices and materials of a mesh carry, whatever file it comes from, into the
/// range that `mesh.h` states, in place, and adds to `clamped`. Tangents that are not finite become
/// zero, which is none.
void clamp_values(TriangleMesh& mesh, ClampedValues& clamped);

}  // namespace uw
