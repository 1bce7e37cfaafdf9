#pragma once

#include <cstddef>

#include "core/optics/medium.h"
#include "core/scene/snow_desc.h"

namespace uw {

/// The snow's own coefficients, as a mean over many particles: `attenuation` is their cross section
/// per volume [1/m], of which they scatter their reflectance as diffuse spheres do (LambertSphere).
struct SnowCoefficients {
    double attenuation = 0;
    Spectrum scattering{};
};
SnowCoefficients snow_coefficients(const SnowDesc& snow);

/// Adds the snow's coefficients to the uniform water of `medium`.
void add_snow(const SnowDesc& snow, Medium& medium);

/// `medium`, whose coefficients hold the snow, without the light that the snow scatters: with the
/// same attenuation. Throws InputError if it scatters more, in some direction and band, than the
/// uniform water does.
Medium without_snow(const SnowDesc& snow, const Medium& medium);

/// `medium`, whose coefficients hold the snow, but scattering only the light that the snow does:
/// with the same attenuation.
Medium snow_alone(const SnowDesc& snow, const Medium& medium);

}  // namespace uw
