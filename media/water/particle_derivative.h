#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/optics/medium.h"
#include "core/scene/volume_desc.h"
#include "core/scene/water_desc.h"

namespace uw {

/// The water's own particles (WaterDesc::small_ppm, large_ppm).
enum class WaterParticles : std::uint8_t { small, large };

/// What more of the water's own particles changes.
struct ParticleDerivative {
    /// Those of the water's medium, and the particles' own.
    std::vector<std::shared_ptr<const PhaseFunction>> phase_functions;
    /// Of the uniform coefficients, by concentration [1/m per ppm]: scattering by phase function.
    OpticalCoefficients per_ppm;
};

/// The derivative of build_water_model's uniform coefficients, which are linear, by the
/// concentration of these particles: upwards, where mineral absorption begins at the preset's own.
/// InputError, as build_water_model; UsageError if the water's scattering is given, so that
/// it has no particles, or if a grid scatters like the water, whose phase function they change.
ParticleDerivative particle_derivative(const WaterDesc& water,
                                       const std::vector<VolumeDesc>& volumes,
                                       WaterParticles particles);

}  // namespace uw
