#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "core/base/output_files.h"

namespace uw {

/// A surface whose every point has the colour of a picture, as a glTF file stores it.
struct PicturedSurface {
    std::string name;                                // of its node and material
    std::span<const float> positions, normals, uvs;  // as in TriangleMesh; normals may be empty
    std::span<const std::uint32_t> triangles;
    std::span<const std::byte> picture;  // an image file's bytes
    std::string picture_type;            // "image/png"
    /// The picture is the radiance that the black surface gives off, else its diffuse reflectance.
    bool is_emission = false;
};

/// Writes all of a binary glTF 2.0 (.glb) with one surface, whose texels are not interpolated.
/// Throws IoError where it would be larger than the 4 GiB of the format; what cannot be written is
/// for out.commit() to report.
void write_glb(OutputFile& out, const PicturedSurface& surface);

}  // namespace uw
