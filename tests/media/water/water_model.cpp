// ctest labels: unit analytic
#include "media/water/water_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "core/base/error.h"
#include "media/water/water_types.h"
#include "tests/support/water_descs.h"

namespace uw {
namespace {

using namespace test;

TEST(WaterModel, WithoutParticlesItIsPureWater) {
    WaterDesc water = basic_water();
    water.small_ppm = 0;
    water.temperature = 12;
    water.salinity = 20;
    const WaterModel model = build_water_model(water, {});
    expect_consistent(model);
    EXPECT_EQ(model.medium.band_count(), 3);
    EXPECT_EQ(model.medium.constituent_count(), 0);
    ASSERT_EQ(model.medium.phase_count(), 1);
    EXPECT_EQ(model.medium.phase_functions[0]->description(), "einstein-smoluchowski");
    EXPECT_TRUE(model.warnings.empty());
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_DOUBLE_EQ(model.medium.uniform.absorption[i],
                         pure_water_absorption(water.bands_nm[i], 12, 20));
        EXPECT_DOUBLE_EQ(model.medium.uniform.scattering[0][i],
                         water_scattering(water.bands_nm[i], 20));
    }
    for (std::size_t i = 3; i < static_cast<std::size_t>(k_max_bands); ++i)
        EXPECT_EQ(model.medium.uniform.absorption[i], 0);
}

// Physics section 1 written out: b and beta of water with both kinds of particles.
TEST(WaterModel, BackgroundParticlesByHand) {
    WaterDesc water = basic_water();
    water.bands_nm = {550, 440};
    water.small_ppm = 0.03;
    water.large_ppm = 0.05;
    const WaterModel model = build_water_model(water, {});
    expect_consistent(model);
    EXPECT_EQ(model.medium.phase_count(), 3);
    EXPECT_EQ(model.medium.constituent_count(), 0);
    EXPECT_EQ(model.small_ppm, 0.03);
    EXPECT_EQ(model.large_ppm, 0.05);
    EXPECT_NEAR(total_scattering(model.medium.uniform, 0),
                water_scattering(550, 35) + 0.03 * 1.34 + 0.05 * 0.312, 1e-15);
    EXPECT_NEAR(total_scattering(model.medium.uniform, 1),
                water_scattering(440, 35) + 0.03 * 1.34 * std::pow(1.25, 1.7) +
                    0.05 * 0.312 * std::pow(1.25, 0.3),
                1e-15);
    // At 90 degrees the tables' own values 0.012 and 6.3e-5, rescaled from the tables' integrals
    // (1.3247, 0.31027: five digits) to 1.34 and 0.312
    EXPECT_NEAR(
        vsf(model.medium, model.medium.uniform, 0, std::numbers::pi / 2),
        water_vsf_90(550, 35) + 0.03 * 0.012 * 1.34 / 1.3247 + 0.05 * 6.3e-5 * 0.312 / 0.31027,
        1e-4 * 0.03 * 0.012);
    EXPECT_EQ(model.medium.uniform.absorption[0], pure_water_absorption(550, 20, 35));
}

// 0.041 m^2/g at 443 nm; one ppm is 2 g/m^3 of small and 1 g/m^3 of large particles.
TEST(WaterModel, MineralAbsorptionByHand) {
    WaterDesc water = basic_water();
    water.bands_nm = {443, 543};
    water.small_ppm = 3;
    water.large_ppm = 5;
    water.mineral_absorption = true;
    const WaterModel model = build_water_model(water, {volume_of({particle_grid("d", 1, 1)})});
    EXPECT_NEAR(model.medium.uniform.absorption[0] - pure_water_absorption(443, 20, 35),
                0.041 * (3 * 2 + 5 * 1), 1e-14);
    EXPECT_NEAR(model.medium.constituents[0].per_unit.absorption[1], 0.041 * 2 * std::exp(-1.23),
                1e-15);
    EXPECT_NEAR(model.medium.constituents[1].per_unit.absorption[1], 0.041 * std::exp(-1.23),
                1e-15);
}

TEST(WaterModel, PresetAndItsOverrides) {
    WaterDesc water = basic_water();
    water.preset = "jerlov-ii";
    const JerlovPreset& preset = jerlov_preset("jerlov-II");
    const WaterModel plain = build_water_model(water, {});
    EXPECT_EQ(plain.small_ppm, preset.small_ppm);
    EXPECT_EQ(plain.large_ppm, preset.large_ppm);
    EXPECT_TRUE(plain.warnings.empty());
    EXPECT_DOUBLE_EQ(plain.medium.uniform.absorption[1], jerlov_absorption(preset, 540, 20, 35));

    // its own particles' absorption was measured with it: only what exceeds them is added
    water.mineral_absorption = true;
    EXPECT_EQ(build_water_model(water, {}).medium.uniform.absorption,
              plain.medium.uniform.absorption);

    water.small_ppm = preset.small_ppm + 1;
    const WaterModel more = build_water_model(water, {});
    EXPECT_EQ(more.small_ppm, preset.small_ppm + 1);
    EXPECT_EQ(more.large_ppm, preset.large_ppm);
    EXPECT_NEAR(more.medium.uniform.absorption[2] - plain.medium.uniform.absorption[2],
                0.082 * std::exp(-0.0123 * 7), 1e-12);

    water.mineral_absorption = false;
    water.absorption = PerBand{0.3, 0.07, 0.03};
    const WaterModel given = build_water_model(water, {});
    EXPECT_EQ(given.medium.uniform.absorption[0], 0.3);
    EXPECT_EQ(given.medium.uniform.absorption[2], 0.03);
    EXPECT_NEAR(total_scattering(given.medium.uniform, 1), total_scattering(more.medium.uniform, 1),
                1e-15);

    water = basic_water();
    water.preset = "jerlov-IB";  // measured from 412 to 555 nm: 380 is outside
    water.bands_nm = {620, 540, 380};
    const WaterModel beyond = build_water_model(water, {});
    ASSERT_EQ(beyond.warnings.size(), 1U);
    EXPECT_NE(beyond.warnings[0].find("at 380 nm the picture"), std::string::npos)
        << beyond.warnings[0];
}

TEST(WaterModel, ExplicitScatteringReplacesMoleculesAndParticles) {
    WaterDesc water = basic_water();
    water.preset = "jerlov-II";
    water.scattering = ScatteringDesc{{0.2, 0.3, 0.4}, hg(0.9)};
    const WaterModel model = build_water_model(water, {});
    expect_consistent(model);
    ASSERT_EQ(model.medium.phase_count(), 1);
    EXPECT_EQ(model.medium.phase_functions[0]->description(), "henyey-greenstein g=0.9");
    EXPECT_EQ(model.medium.uniform.scattering[0][1], 0.3);
    EXPECT_EQ(model.small_ppm, 0);
    EXPECT_EQ(model.large_ppm, 0);
    EXPECT_DOUBLE_EQ(model.medium.uniform.absorption[1],
                     jerlov_absorption(jerlov_preset("jerlov-II"), 540, 20, 35));
    EXPECT_TRUE(model.warnings.empty());
    water.small_ppm = 0.1;
    EXPECT_EQ(build_water_model(water, {}).warnings.size(), 1U);
}

TEST(WaterModel, WaterThatDoesNotScatterHasNoPhaseFunction) {
    WaterDesc water = basic_water();
    water.absorption = PerBand{0.1, 0.1, 0.1};
    water.scattering = ScatteringDesc{{0, 0, 0}, hg(0.9)};
    const WaterModel model = build_water_model(water, {});
    expect_consistent(model);
    EXPECT_EQ(model.medium.phase_count(), 0);
    EXPECT_EQ(model.medium.uniform.attenuation(0), 0.1);
}

TEST(WaterModel, BandsOutsideTheTables) {
    WaterDesc water = basic_water();
    water.bands_nm = {550, 1064};
    const std::string message = refusal([&] { build_water_model(water, {}); });
    EXPECT_EQ(message.find("scene.yaml:3:1: water: bands 1064 nm"), 0U) << message;
    EXPECT_NE(message.find("300 to 900"), std::string::npos) << message;
    water.absorption = PerBand{0.1, 12};
    EXPECT_EQ(build_water_model(water, {}).medium.uniform.absorption[1], 12);
    water.bands_nm = {0.55, 0.45};  // micrometres
    EXPECT_NE(refusal([&] { build_water_model(water, {}); }).find("nanometres"), std::string::npos);
    water.bands_nm.assign(33, 500.0);
    EXPECT_THROW(build_water_model(water, {}), InputError);
    water.bands_nm.clear();
    EXPECT_THROW(build_water_model(water, {}), InputError);
}

TEST(WaterModel, ErrorsSayWhere) {
    WaterDesc water = basic_water();
    water.preset = "jerlov-X";
    EXPECT_EQ(refusal([&] { build_water_model(water, {}); }).find(water.where), 0U);
    water = basic_water();
    water.scattering = ScatteringDesc{{1, 1, 1}, hg(1.5)};
    EXPECT_EQ(refusal([&] { build_water_model(water, {}); }).find("scene.yaml:5:9"), 0U);
    water.scattering = ScatteringDesc{{1, 1}, hg(0.5)};
    EXPECT_EQ(refusal([&] { build_water_model(water, {}); }).find(water.where), 0U);
}

}  // namespace
}  // namespace uw
