// ctest labels: unit
// What more of the water's own particles changes, against water that has more.
#include "media/water/water_model.h"

#include <gtest/gtest.h>

#include "core/base/error.h"

namespace uw::test {
namespace {

WaterDesc water_with(double small_ppm, double large_ppm) {
    WaterDesc water;
    water.bands_nm = {620, 540, 450};
    water.preset = "jerlov-II";
    water.small_ppm = small_ppm;
    water.large_ppm = large_ppm;
    return water;
}

/// From one water to another that differs in the large particles alone.
void expect_difference(WaterDesc from, double more_ppm) {
    const ParticleDerivative found = particle_derivative(from, {}, WaterParticles::large);
    const Medium before = build_water_model(from, {}).medium;
    *from.large_ppm += more_ppm;
    const Medium after = build_water_model(from, {}).medium;
    const Spectrum scattering = found.per_ppm.total_scattering();
    for (std::size_t b = 0; b < 3; ++b) {
        EXPECT_GT(scattering[b], 0);
        const double more_scattering =
            after.uniform.total_scattering()[b] - before.uniform.total_scattering()[b];
        EXPECT_NEAR(more_ppm * scattering[b], more_scattering, 1e-9);
        const double more_absorption = after.uniform.absorption[b] - before.uniform.absorption[b];
        EXPECT_NEAR(more_ppm * found.per_ppm.absorption[b], more_absorption, 1e-9);
    }
}

TEST(ParticleDerivative, IsWhatMoreOfThemAdds) {
    for (const double ppm : {0.0, 0.01, 0.2, 3.0}) expect_difference(water_with(0.03, ppm), 0.005);
}

TEST(ParticleDerivative, HoldsAbsorptionBeyondThePresetsOwnParticles) {
    WaterDesc own = water_with(0.03, 0);
    own.large_ppm.reset();
    const double preset_ppm = build_water_model(own, {}).large_ppm;
    for (const double ppm : {0.5 * preset_ppm, preset_ppm, 2 * preset_ppm}) {
        WaterDesc water = water_with(0.03, ppm);
        water.mineral_absorption = true;
        expect_difference(water, 0.1 * preset_ppm);
        const ParticleDerivative found = particle_derivative(water, {}, WaterParticles::large);
        if (ppm < preset_ppm)
            EXPECT_NEAR(found.per_ppm.absorption[1], 0, 1e-12);
        else
            EXPECT_GT(found.per_ppm.absorption[1], 1e-4);
    }
}

TEST(ParticleDerivative, HasThePhaseFunctionOfParticlesThatAreNotThere) {
    const WaterDesc none = water_with(0, 0);
    EXPECT_EQ(build_water_model(none, {}).medium.phase_count(), 1);
    const ParticleDerivative found = particle_derivative(none, {}, WaterParticles::small);
    ASSERT_EQ(found.phase_functions.size(), 2U);
    EXPECT_EQ(found.per_ppm.scattering[0][0], 0);
    EXPECT_GT(found.per_ppm.scattering[1][0], 0);
}

TEST(ParticleDerivative, IsRefusedWhereThereIsNone) {
    WaterDesc water = water_with(0.03, 0.05);
    VolumeDesc volume;
    GridMappingDesc grid;
    grid.grid = "ink";
    grid.optics = GridMappingDesc::Optics{{1, 1, 1}, {1, 1, 1}, {}};
    volume.grids = {grid};
    EXPECT_THROW(particle_derivative(water, {volume}, WaterParticles::small), UsageError);
    volume.grids[0].optics->scattering = {0, 0, 0};
    EXPECT_NO_THROW(particle_derivative(water, {volume}, WaterParticles::small));
    water.scattering.emplace();
    EXPECT_THROW(particle_derivative(water, {}, WaterParticles::small), UsageError);
}

}  // namespace
}  // namespace uw::test
