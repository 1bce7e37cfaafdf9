// ctest labels: unit analytic
#include "media/water_model.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

#include "core/error.h"
#include "media/jerlov.h"
#include "media/pure_water.h"
#include "tests/support/phase_function_laws.h"

namespace uw {
namespace {

WaterDesc basic_water() {
    WaterDesc water;
    water.bands_nm = {620, 540, 450};
    water.where = "scene.yaml:3:1: water";
    return water;
}

GridMappingDesc particle_grid(const std::string& name, double small_ppm, double large_ppm) {
    GridMappingDesc grid;
    grid.grid = name;
    grid.small_ppm = small_ppm;
    grid.large_ppm = large_ppm;
    grid.where = "scene.yaml:9:5: volumes[0].grids." + name;
    return grid;
}

PhaseDesc hg(double g) {
    PhaseDesc phase;
    phase.g = g;
    phase.where = "scene.yaml:5:9: water.scattering.phase";
    return phase;
}

GridMappingDesc optics_grid(const std::string& name, const PerBand& absorption,
                            const PerBand& scattering, std::optional<PhaseDesc> phase) {
    GridMappingDesc grid = particle_grid(name, 0, 0);
    grid.optics = GridMappingDesc::Optics{absorption, scattering, std::move(phase)};
    return grid;
}

VolumeDesc volume_of(std::vector<GridMappingDesc> grids) {
    VolumeDesc volume;
    volume.grids = std::move(grids);
    return volume;
}

double total_scattering(const OpticalCoefficients& x, std::size_t band) {
    double b = 0;
    for (const Spectrum& b_m : x.scattering) b += b_m[band];
    return b;
}

/// beta(psi) of coefficients of the medium in one band.
double vsf(const Medium& medium, const OpticalCoefficients& x, std::size_t band, double psi) {
    double beta = 0;
    for (std::size_t m = 0; m < medium.phase_functions.size(); ++m)
        beta += x.scattering[m][band] * medium.phase_functions[m]->evaluate(psi);
    return beta;
}

std::string refusal(const std::function<void()>& action) {
    try {
        action();
    } catch (const InputError& error) {
        return error.what();
    }
    return "nothing was refused";
}

void expect_consistent(const WaterModel& model) {
    const Medium& medium = model.medium;
    const auto phases = medium.phase_functions.size();
    EXPECT_EQ(medium.uniform.scattering.size(), phases);
    for (const Constituent& constituent : medium.constituents)
        EXPECT_EQ(constituent.per_unit.scattering.size(), phases);
    for (const auto& volume : model.loads)
        for (const auto& grid : volume)
            for (const GridLoad& load : grid) {
                EXPECT_GE(load.constituent, 0);
                EXPECT_LT(load.constituent, medium.constituent_count());
            }
}

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

// Linearity: the water with particles everywhere equals clear water plus that many units of the
// constituents a grid would add.
TEST(WaterModel, GridParticlesAddLikeTheBackground) {
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

TEST(WaterModel, DissolvedMatterAddsToAbsorption) {
    WaterDesc water = basic_water();
    water.cdom = 0.2;
    water.chlorophyll = 1;
    water.bands_nm = {440};
    const WaterModel model = build_water_model(water, {});
    EXPECT_NEAR(model.medium.uniform.absorption[0],
                pure_water_absorption(440, 20, 35) + 0.2 + 0.0403, 1e-15);
    EXPECT_TRUE(model.warnings.empty());
    water.bands_nm = {380};
    EXPECT_EQ(build_water_model(water, {}).warnings.size(), 1U);  // chlorophyll below 400 nm
    water.absorption = PerBand{0.5};
    const WaterModel given = build_water_model(water, {});
    EXPECT_EQ(given.medium.uniform.absorption[0], 0.5);
    EXPECT_EQ(given.warnings.size(), 1U);  // cdom and chlorophyll are not used
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
    water.preset = "jerlov-IB";  // measured from 412 to 555 nm: 620 is outside
    const WaterModel beyond = build_water_model(water, {});
    ASSERT_EQ(beyond.warnings.size(), 1U);
    EXPECT_NE(beyond.warnings[0].find("bands 620 nm"), std::string::npos) << beyond.warnings[0];
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

TEST(WaterModel, OnlyMappedParticlesBecomeConstituents) {
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

TEST(WaterModel, IdenticalOpticsShareOneConstituent) {
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
TEST(WaterModel, OpticsWithoutAPhaseScatterLikeTheWater) {
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

TEST(WaterModel, OpticsNeedAPhaseInWaterThatDoesNotScatter) {
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

class PhaseTableFile : public ::testing::Test {
  protected:
    void SetUp() override {
        std::string pattern = (std::filesystem::temp_directory_path() / "uwvdb-XXXXXX").string();
        ASSERT_NE(mkdtemp(pattern.data()), nullptr);
        folder_ = pattern;
        phase_.type = PhaseDesc::Type::table;
        phase_.file = folder_ / "phase.csv";
        phase_.where = "scene.yaml:5:9: water.scattering.phase.file";
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    WaterModel build(const std::string& text) {
        std::ofstream(phase_.file) << text;
        return build();
    }
    WaterModel build() {
        WaterDesc water = basic_water();
        water.scattering = ScatteringDesc{{0.2, 0.2, 0.2}, phase_};
        return build_water_model(water, {});
    }

    std::filesystem::path folder_;
    PhaseDesc phase_;
};

TEST_F(PhaseTableFile, IsReadAndNormalised) {
    const WaterModel model = build("# 1/sr\nangle_deg,phase\n0,0.0796\n180,0.0796\n");
    EXPECT_TRUE(model.warnings.empty());
    test::expect_phase_function_laws(*model.medium.phase_functions.at(0));
    EXPECT_NEAR(model.medium.phase_functions[0]->evaluate(1), 1 / (4 * std::numbers::pi), 1e-12);
}

TEST_F(PhaseTableFile, WarnsOfWhatIsNoPhaseFunction) {
    EXPECT_EQ(build("angle_deg,phase\n0,1\n180,1\n").warnings.size(), 1U);   // 4 pi
    const WaterModel cut = build("angle_deg,phase\n0,0.0796\n90,0.0796\n");  // half is missing
    ASSERT_EQ(cut.warnings.size(), 1U);
    EXPECT_NE(cut.warnings[0].find("50 %"), std::string::npos) << cut.warnings[0];
}

TEST_F(PhaseTableFile, ErrorsSayWhere) {
    EXPECT_THROW(build(), IoError);
    const std::string message = refusal([&] { build("angle_deg,phase\n0,1\n"); });
    EXPECT_EQ(message.find(phase_.where), 0U) << message;
    EXPECT_NE(message.find("phase.csv"), std::string::npos) << message;
    EXPECT_THROW(build(std::string(5 << 20, '1')), InputError);  // larger than any table
    EXPECT_THROW(build(std::string("\0\xff\n\0,\n", 6)), InputError);
    phase_.file = "/dev/zero";
    EXPECT_THROW(build(), IoError);
}

}  // namespace
}  // namespace uw
