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

Medium with_one_more(const WaterDesc& water, WaterParticles particles) {
    return with_one_more_ppm(build_water_model(water, {}), water, {}, particles);
}

/// Expects that `more_ppm` change absorption and the volume scattering function as far as they do
/// in a model that is built with so many more particles. 1e-9 of what the water scatters forward
/// per ppm: rounding.
void expect_difference(const WaterDesc& from, WaterParticles particles, double more_ppm) {
    const Medium before = build_water_model(from, {}).medium;
    const Medium one_more = with_one_more(from, particles);
    WaterDesc to = from;
    *(particles == WaterParticles::small ? to.small_ppm : to.large_ppm) += more_ppm;
    const Medium after = build_water_model(to, {}).medium;
    for (std::size_t b = 0; b < 3; ++b) {
        EXPECT_NEAR(more_ppm * (one_more.uniform.absorption[b] - before.uniform.absorption[b]),
                    after.uniform.absorption[b] - before.uniform.absorption[b], 1e-9);
        for (const double psi : {0.01, 0.3, 1.5, 3.0}) {
            const auto beta = [&](const Medium& medium) {
                return vsf(medium, medium.uniform, b, psi);
            };
            const double difference = beta(after) - beta(before);
            EXPECT_GT(difference, 0);
            EXPECT_NEAR(more_ppm * (beta(one_more) - beta(before)), difference,
                        1e-9 * beta(one_more));
        }
    }
}

TEST(ParticleDerivative, IsWhatMoreOfThemAdds) {
    for (const double small_ppm : {0.0, 0.03})
        for (const double large_ppm : {0.0, 0.01, 0.2, 3.0})
            for (const WaterParticles particles : {WaterParticles::small, WaterParticles::large})
                expect_difference(water_with(small_ppm, large_ppm), particles, 0.005);
}

TEST(ParticleDerivative, HoldsAbsorptionBeyondThePresetsOwnParticles) {
    WaterDesc own = water_with(0.03, 0);
    own.large_ppm.reset();
    const double preset_ppm = build_water_model(own, {}).large_ppm;
    for (const double ppm : {0.5 * preset_ppm, preset_ppm, 2 * preset_ppm}) {
        WaterDesc water = water_with(0.03, ppm);
        water.mineral_absorption = true;
        expect_difference(water, WaterParticles::large, 0.1 * preset_ppm);
        const double more = with_one_more(water, WaterParticles::large).uniform.absorption[1] -
                            build_water_model(water, {}).medium.uniform.absorption[1];
        if (ppm < preset_ppm)
            EXPECT_EQ(more, 0);
        else
            EXPECT_GT(more, 1e-4);
    }
}

// Whoever has coefficients by the medium's phase functions can use them with the new one, too.
TEST(ParticleDerivative, KeepsThePhaseFunctionsInOrder) {
    for (const double large_ppm : {0.0, 0.1}) {
        const WaterDesc none = water_with(0, large_ppm);
        const Medium before = build_water_model(none, {}).medium;
        const Medium more = with_one_more(none, WaterParticles::small);
        ASSERT_EQ(more.phase_count(), before.phase_count() + 1);
        for (std::size_t m = 0; m < before.phase_functions.size(); ++m) {
            EXPECT_EQ(more.phase_functions[m]->description(),
                      before.phase_functions[m]->description());
            EXPECT_EQ(more.uniform.scattering[m], before.uniform.scattering[m]);
        }
        EXPECT_GT(more.uniform.scattering.back()[0], 0);
    }
}

TEST(ParticleDerivative, IsRefusedWhereThereIsNone) {
    WaterDesc water = water_with(0.03, 0.05);
    VolumeDesc volume;
    GridMappingDesc grid;
    grid.grid = "ink";
    grid.optics = GridMappingDesc::Optics{{1, 1, 1}, {1, 1, 1}, {}};
    volume.grids = {grid};
    const WaterModel model = build_water_model(water, {});
    const auto more = [&](const std::vector<VolumeDesc>& volumes) {
        return with_one_more_ppm(model, water, volumes, WaterParticles::small);
    };
    EXPECT_THROW(more({volume}), UsageError);
    volume.grids[0].optics->scattering = {0, 0, 0};
    EXPECT_NO_THROW(more({volume}));
    water.scattering.emplace();
    EXPECT_THROW(more({}), UsageError);
}

}  // namespace
}  // namespace uw::test
