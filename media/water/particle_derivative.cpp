#include "media/water/particle_derivative.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/error.h"
#include "media/water/jerlov.h"
#include "media/water/water_model.h"

namespace uw {

namespace {

constexpr double k_least_step_ppm = 1e-6;  // beyond rounding

void refuse_other_water(const WaterDesc& water, const std::vector<VolumeDesc>& volumes) {
    if (water.scattering)
        throw UsageError(
            "the water's scattering is given, so that it has no particles; remove "
            "water.scattering, or take the derivative water.scattering");
    const auto scatters_like_water = [](const GridMappingDesc& grid) {
        return grid.optics && !grid.optics->phase &&
               std::ranges::any_of(grid.optics->scattering, [](double b) { return b > 0; });
    };
    for (const VolumeDesc& volume : volumes)
        for (const GridMappingDesc& grid : volume.grids) {
            if (!scatters_like_water(grid)) continue;
            throw UsageError(
                fmt::format("the grid {} scatters like the water, whose phase function changes "
                            "with its particles; give the grid a phase",
                            grid.grid));
        }
}

/// How far the coefficients are linear from here.
double linear_step(const WaterDesc& water, double ppm, double preset_ppm) {
    const bool measured = !water.preset.empty() && !water.absorption;
    return measured && ppm < preset_ppm - k_least_step_ppm ? preset_ppm - ppm : 1.0;
}

}  // namespace

ParticleDerivative particle_derivative(const WaterDesc& water,
                                       const std::vector<VolumeDesc>& volumes,
                                       WaterParticles particles) {
    refuse_other_water(water, volumes);
    const bool is_small = particles == WaterParticles::small;
    const WaterModel model = build_water_model(water, volumes);
    const double ppm = is_small ? model.small_ppm : model.large_ppm;
    double preset_ppm = 0;
    if (!water.preset.empty()) {
        const JerlovPreset& preset = jerlov_preset(water.preset);
        preset_ppm = is_small ? preset.small_ppm : preset.large_ppm;
    }
    const double step = linear_step(water, ppm, preset_ppm);
    // Both above the concentration, which may be 0: then the medium lacks the phase function.
    const auto with = [&](double more) {
        WaterDesc changed = water;
        (is_small ? changed.small_ppm : changed.large_ppm) = ppm + more;
        return build_water_model(changed, volumes).medium;
    };
    const Medium near = with(step / 2);
    Medium far = with(step);
    ParticleDerivative result{std::move(far.phase_functions), std::move(far.uniform)};
    const auto make_difference = [&](Spectrum& value, const Spectrum& from) {
        value = (value - from) / (step / 2);
    };
    make_difference(result.per_ppm.absorption, near.uniform.absorption);
    for (std::size_t m = 0; m < result.per_ppm.scattering.size(); ++m)
        make_difference(result.per_ppm.scattering[m], near.uniform.scattering[m]);
    return result;
}

}  // namespace uw
