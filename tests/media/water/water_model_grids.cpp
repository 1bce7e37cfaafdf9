// ctest labels: unit analytic
#include "media/water/water_model.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/support/water_descs.h"

namespace uw {
namespace {

using namespace test;

// Linearity: the water with particles everywhere equals clear water plus that many units of the
// constituents a grid would add.
TEST(WaterModelGrids, GridParticlesAddLikeTheBackground) {
    for (const bool mineral : {false, true}) {
        WaterDesc clear = basic_water();
        clear.mineral_absorption = mineral;
        WaterDesc turbid = clear;
        turbid.small_ppm = 0.7;
        turbid.large_ppm = 1.9;
        const WaterModel by_grid =
            build_water_model(clear, {volume_of({particle_grid("density", 2, 10)})});
        const WaterModel everywhere = build_water_model(turbid, {});
        expect_consistent(by_grid);
        const Medium& medium = by_grid.medium;
        ASSERT_EQ(medium.constituent_count(), 2);
        EXPECT_EQ(medium.constituents[0].name, "small");
        EXPECT_EQ(medium.constituents[1].name, "large");
        EXPECT_EQ(medium.constituents[0].unit, "ppm");
        ASSERT_EQ(by_grid.loads.at(0).at(0).size(), 2U);
        EXPECT_EQ(by_grid.loads[0][0][0].per_unit, 2);
        EXPECT_EQ(by_grid.loads[0][0][1].per_unit, 10);
        for (std::size_t i = 0; i < 3; ++i) {
            const int band = static_cast<int>(i);
            const double c = medium.uniform.attenuation(band) +
                             0.7 * medium.constituents[0].per_unit.attenuation(band) +
                             1.9 * medium.constituents[1].per_unit.attenuation(band);
            EXPECT_NEAR(c, everywhere.medium.uniform.attenuation(band), 1e-12);
            for (const double psi : {0.0, 0.01, 0.5, 2.0, 3.1}) {
                const double beta = vsf(medium, medium.uniform, i, psi) +
                                    0.7 * vsf(medium, medium.constituents[0].per_unit, i, psi) +
                                    1.9 * vsf(medium, medium.constituents[1].per_unit, i, psi);
                EXPECT_NEAR(beta, vsf(everywhere.medium, everywhere.medium.uniform, i, psi),
                            1e-12 * beta);
            }
        }
    }
}

TEST(WaterModelGrids, OnlyMappedParticlesBecomeConstituents) {
    const WaterModel model = build_water_model(
        basic_water(),
        {volume_of({particle_grid("a", 0, 3)}), volume_of({particle_grid("b", 0, 4)})});
    expect_consistent(model);
    ASSERT_EQ(model.medium.constituent_count(), 1);
    EXPECT_EQ(model.medium.constituents[0].name, "large");
    EXPECT_EQ(model.medium.phase_count(), 2);  // molecules and large particles
    EXPECT_EQ(model.loads.at(0).at(0).at(0).constituent, 0);
    EXPECT_EQ(model.loads.at(1).at(0).at(0).constituent, 0);
    EXPECT_EQ(model.loads[1][0][0].per_unit, 4);
}

TEST(WaterModelGrids, IdenticalOpticsShareOneConstituent) {
    const PerBand a{0.1, 0.2, 0.3}, b{1, 2, 3};
    WaterDesc water = basic_water();
    const WaterModel model = build_water_model(
        water,
        {volume_of({optics_grid("sediment", a, b, hg(0.8)), optics_grid("other", a, b, hg(0.8))}),
         volume_of({optics_grid("sediment", a, b, hg(0.7)), optics_grid("small", b, a, hg(0.8)),
                    particle_grid("density", 1, 0)})});
    expect_consistent(model);
    const Medium& medium = model.medium;
    ASSERT_EQ(medium.constituent_count(), 4);
    EXPECT_EQ(medium.constituents[0].name, "sediment");
    EXPECT_EQ(medium.constituents[0].unit, "1");
    EXPECT_EQ(medium.constituents[1].name, "sediment-2");
    EXPECT_EQ(medium.constituents[2].name, "small-2");
    EXPECT_EQ(medium.constituents[3].name, "small");
    EXPECT_EQ(model.loads[0][0][0].constituent, 0);
    EXPECT_EQ(model.loads[0][1][0].constituent, 0);
    EXPECT_EQ(model.loads[1][0][0].constituent, 1);
    EXPECT_EQ(model.loads[1][1][0].constituent, 2);
    EXPECT_EQ(model.loads[1][2][0].constituent, 3);
    EXPECT_EQ(model.loads[0][0][0].per_unit, 1);
    EXPECT_EQ(medium.phase_count(), 4);  // molecules, two HG, small particles
    EXPECT_EQ(medium.constituents[0].per_unit.absorption[1], 0.2);
    EXPECT_EQ(medium.constituents[0].per_unit.attenuation(2), 3.3);
}

// Optics without a phase function have the shape of the uniform water's VSF in each band.
TEST(WaterModelGrids, OpticsWithoutAPhaseScatterLikeTheWater) {
    WaterDesc water = basic_water();
    water.small_ppm = 0.2;
    water.large_ppm = 0.4;
    const WaterModel model = build_water_model(
        water, {volume_of({optics_grid("dye", {0, 0, 0}, {0.5, 0.6, 0.7}, std::nullopt)})});
    expect_consistent(model);
    const Medium& medium = model.medium;
    EXPECT_EQ(medium.phase_count(), 3);
    const OpticalCoefficients& dye = medium.constituents.at(0).per_unit;
    for (std::size_t i = 0; i < 3; ++i) {
        const double b = 0.5 + 0.1 * static_cast<double>(i);
        EXPECT_NEAR(total_scattering(dye, i), b, 1e-14);
        for (const double psi : {0.0, 0.1, 1.5, 3.0})
            EXPECT_NEAR(vsf(medium, dye, i, psi) / b,
                        vsf(medium, medium.uniform, i, psi) / total_scattering(medium.uniform, i),
                        1e-12 * vsf(medium, dye, i, psi) / b);
    }
}

TEST(WaterModelGrids, OpticsNeedAPhaseInWaterThatDoesNotScatter) {
    WaterDesc water = basic_water();
    water.scattering = ScatteringDesc{{0.1, 0, 0.1}, hg(0.9)};
    const auto build = [&](const PerBand& b, std::optional<PhaseDesc> phase) {
        return build_water_model(water,
                                 {volume_of({optics_grid("dye", {0, 0, 0}, b, std::move(phase))})});
    };
    const std::string message = refusal([&] { build({1, 1, 1}, std::nullopt); });
    EXPECT_EQ(message.find("scene.yaml:9:5: volumes[0].grids.dye: "), 0U) << message;
    EXPECT_NE(message.find("540 nm"), std::string::npos) << message;
    EXPECT_EQ(build({1, 0, 1}, std::nullopt).medium.phase_count(), 1);
    EXPECT_EQ(build({1, 1, 1}, hg(0.5)).medium.phase_count(), 2);
}

}  // namespace
}  // namespace uw
