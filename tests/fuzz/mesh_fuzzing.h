#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/mesh.h"
#include "core/geometry/mesh_reader.h"
#include "tests/fuzz/fuzzing.h"

namespace uw::fuzz {

/// Reads a mesh at a time of its animations, if any; what comes of it can be traced: corners exist,
/// and all that they carry is finite.
inline void read_mesh_file(const std::filesystem::path& file,
                           const std::optional<double>& time = {}) {
    parse([&] {
        std::vector<std::string> warnings;
        const MeshFile content = read_mesh(file, warnings, GltfUse{.pbr = true, .time = time});
        for (const std::string& warning : warnings) check_message(warning);
        for (const std::uint32_t corner : content.mesh.triangles)
            for (std::size_t k = 0; k < 3; ++k)
                if (!std::isfinite(content.mesh.positions.at(3 * std::size_t{corner} + k)))
                    __builtin_trap();
        for (const auto* values : {&content.mesh.normals, &content.mesh.uvs[0],
                                   &content.mesh.colors, &content.mesh.tangents})
            for (const float value : *values)
                if (!std::isfinite(value)) __builtin_trap();
    });
}

}  // namespace uw::fuzz
