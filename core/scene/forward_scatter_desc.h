#pragma once

#include "core/scene/source_location.h"

namespace uw {

/// Light that is blurred by scattering through small angles (docs/physics.md, section 6).
struct ForwardScatterDesc {
    /// The shape of the blur's spectrum.
    enum class Shape { gaussian, exponential };
    double K = 0;  ///< strength, >= 0; 0: no forward scatter
    double G = 0;  ///< attenuation of the forward-scattered light [1/m], |G| <= c
    double B = 0;  ///< width >= 0: the spectrum falls as e^{-B R f}, f in cycles/rad [rad/m]
    Shape shape = Shape::gaussian;
    SourceLocation where = "water.forward_scatter";

    friend bool operator==(const ForwardScatterDesc&, const ForwardScatterDesc&) = default;
};

}  // namespace uw
