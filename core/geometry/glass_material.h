#pragma once

#include "core/base/spectrum.h"
#include "core/geometry/texture.h"

namespace uw {

/// A smooth transparent material.
struct GlassMaterial {
    double n = 1.5;  ///< refractive index; 1 is air
    /// Whether a surface is a whole pane, of both faces, which light passes without an offset; else
    /// surfaces enclose the glass.
    bool is_thin = false;
    double thickness = 0;   ///< of a thin pane [m], which absorbs
    Spectrum absorption{};  ///< per band [1/m]

    friend bool operator==(const GlassMaterial&, const GlassMaterial&) = default;
};

/// The same as a mesh file has it, with the absorption of red, green and blue [1/m].
struct FileGlass {
    double n = 1.5;
    bool is_thin = false;
    double thickness = 0;
    Rgb absorption{0, 0, 0};
};

}  // namespace uw
