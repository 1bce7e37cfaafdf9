#pragma once

#include <cstdint>

#include "core/base/vec.h"
#include "core/scene/per_band.h"
#include "core/scene/source_location.h"

namespace uw {

/// Marine snow: discrete particles, drawn one by one (docs/snow.md).
struct SnowDesc {
    /// How the particles' mean is related to the water's coefficients: they hold it already, or
    /// the snow's own coefficients are added to them.
    enum class Mean { included, added };

    double number = 0;  ///< of all diameters below, per m^3, > 0
    /// Diameters of spheres with the particles' cross section, least < greatest [m].
    double least = 0, greatest = 0;
    /// Junge's: the number per interval of diameters dD is proportional to D^-exponent dD.
    double exponent = 4;
    PerBand reflectance;     ///< of the particles' white diffuse surface, 0..1
    Vector3 drift{0, 0, 0};  ///< velocity of all particles [m/s], world
    std::uint64_t seed = 0;
    Mean mean = Mean::included;
    /// Whether depth, position, normal and id are those of a particle that covers most of a pixel.
    bool in_ground_truth = false;
    int most = 1'000'000;  ///< particles to draw in an image, about; the others are their mean
    SourceLocation where;

    friend bool operator==(const SnowDesc&, const SnowDesc&) = default;
};

}  // namespace uw
