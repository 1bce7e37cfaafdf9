// ctest labels: unit analytic
#include "media/water/measured_vsf.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/scene/scene_desc.h"
#include "media/water/species.h"
#include "media/water/water_model.h"
#include "media/water/water_types.h"
#include "tests/support/message_of.h"
#include "tests/support/phase_function_laws.h"
#include "tests/support/scene_folder.h"
#include "tests/support/water_descs.h"

namespace uw {
namespace {

using namespace uw::test;

WaterDesc vsf_water(const std::string& text) {
    return read_water_overrides({"water=" + text});
}

// As published with the measurements, and by integrals of their tables elsewhere.
TEST(MeasuredVsf, PetzoldsWatersScatterAsMuchAsHeFound) {
    const WaterDesc desc = vsf_water(
        "{species: {a: {library: petzold-harbor}, b: {library: petzold-coastal}, c: {library: "
        "petzold-ocean}}}");
    const double molecules = water_scattering(514, 35);
    const std::array published{1.820, 0.219, 0.0372};
    for (std::size_t i = 0; i < 3; ++i) {
        const SpeciesOptics optics = species_optics(desc.species[i], 514, desc);
        EXPECT_NEAR((optics.scattering + molecules) / published[i], 1, 0.01);
        EXPECT_EQ(optics.absorption, 0);
        expect_phase_function_laws(*optics.phase);
    }
    // The molecules are taken away at each angle: at 90 degrees most of the ocean's is theirs.
    const SpeciesOptics ocean = species_optics(desc.species[2], 514, desc);
    EXPECT_NEAR(ocean.scattering * ocean.phase->eval(std::numbers::pi / 2) + water_vsf_90(514, 35),
                2.4593e-4, 1e-9);
    // In the harbour's water, an exact multiple of it, and in that of grids.
    const WaterDesc doubled =
        vsf_water("{species: {h: {library: petzold-harbor}}, particles: {h: 2}, bands: [514]}");
    VolumeDesc volume = volume_of({particle_grid("density", 0, 0)});
    volume.grids[0].amounts = {{0, 3, SpeciesAmount::Unit::own}};
    const WaterModel model = build_water_model(doubled, {volume});
    const double once = species_optics(doubled.species[0], 514, doubled).scattering;
    EXPECT_NEAR(total_scattering(model.medium.uniform, 0), molecules + 2 * once, 1e-12);
    EXPECT_NEAR(total_scattering(model.medium.constituents[0].per_unit, 0), once, 1e-12);
    EXPECT_EQ(model.medium.constituents[0].unit, "sample");
    EXPECT_EQ(model.loads[0][0][0].per_unit, 3);
}

// A power law is continued to 0; the integral has a closed form where sin psi is psi.
TEST(MeasuredVsf, IsContinuedByThePowerLawOfItsFirstAngles) {
    const SceneFolder folder;
    folder.write("vsf.csv", "angle_deg,beta_500\n1,100\n10,3.1622776601683795\n180,0\n");
    WaterDesc desc = vsf_water("{}");
    SpeciesDesc species;
    species.name = "mud";
    species.where = "scene.yaml:4:7: water.species.mud";
    species.vsf = MeasuredVsfDesc{};
    species.vsf->file = folder.path() / "vsf.csv";
    const SpeciesOptics optics = species_optics(species, 500, desc);
    const double degree = std::numbers::pi / 180;
    const auto beta = [&](double psi) { return optics.scattering * optics.phase->eval(psi); };
    for (const double psi : {0.001, 0.01, 0.1, 1.0, 5.0})
        EXPECT_NEAR(beta(psi * degree) / (100 * std::pow(psi, -1.5)), 1, 1e-9) << psi;
    // Held above the last angle.
    folder.write("vsf.csv", "angle_deg,beta_500\n1,100\n170,0.5\n");
    const SpeciesOptics held = species_optics(species, 500, desc);
    EXPECT_NEAR(held.scattering * held.phase->eval(175 * degree), 0.5, 1e-9);
}

TEST(MeasuredVsf, IsLinearBetweenWavelengthsAndHeldBeyond) {
    const SceneFolder folder;
    folder.write("vsf.csv",
                 "angle_deg,beta_500,beta_440,beta_600\n1,10,20,4\n90,0.1,0.3,0.04\n180,0.1,0.2,"
                 "0.05\n");
    folder.write("a.csv", "wavelength_nm,absorption\n400,0.3\n600,0.1\n");
    const std::string text = "{species: {mud: {vsf: " + (folder.path() / "vsf.csv").string() +
                             ", water: removed, sample: 4 g/m3, absorption: {file: " +
                             (folder.path() / "a.csv").string() +
                             "}}}, particles: {mud: 8 g/m3}, bands: [470, 550, 700]}";
    const WaterDesc desc = vsf_water(text);
    const auto beta = [&](double nm) {
        const SpeciesOptics optics = species_optics(desc.species[0], nm, desc);
        return optics.scattering * optics.phase->eval(std::numbers::pi / 2);
    };
    EXPECT_NEAR(beta(440), 0.3, 1e-12);
    EXPECT_NEAR(beta(470), 0.2, 1e-12);
    EXPECT_NEAR(beta(550), 0.07, 1e-12);
    EXPECT_NEAR(beta(700), 0.04, 1e-12);
    EXPECT_NEAR(species_optics(desc.species[0], 500, desc).absorption, 0.2, 1e-12);
    const WaterModel model = build_water_model(desc, {});
    ASSERT_EQ(model.warnings.size(), 1U);
    EXPECT_NE(model.warnings[0].find("from 440 to 600 nm, and is taken to be the same at 700 nm"),
              std::string::npos);
    // 8 g/m3 is twice the sample.
    EXPECT_NEAR(vsf(model.medium, model.medium.uniform, 1, std::numbers::pi / 2),
                2 * 0.07 + water_vsf_90(550, 35), 1e-9);
    EXPECT_EQ(files_of(desc.species[0]).size(), 2U);
}

TEST(MeasuredVsf, ErrorsSayWhatIsWrong) {
    const SceneFolder folder;
    const auto error = [&](const std::string& csv, const std::string& keys) {
        folder.write("vsf.csv", csv);
        return message_of<InputError>([&] {
            const WaterDesc desc = vsf_water("{bands: [500], species: {mud: {vsf: " +
                                             (folder.path() / "vsf.csv").string() + keys + "}");
            (void)build_water_model(desc, {});
        });
    };
    const std::string good = "angle_deg,beta_500\n1,1\n180,0.01\n";
    const auto contains = [](const std::string& text, const std::string& part) {
        EXPECT_NE(text.find(part), std::string::npos) << text;
    };
    contains(error(good, "}}"), "included or removed");
    contains(error("angle_deg,beta\n1,1\n", ", water: removed}}, particles: {mud: 1}"),
             "has a column 'beta'");
    contains(error("angle_deg,beta_500\n1,1\n90,1e-6\n180,1\n",
                   ", water: included}}, particles: {mud: 1}"),
             "at 90 degrees and 500 nm the sample scatters less than water's molecules");
    contains(error(good, ", water: removed}}, particles: {mud: 3 g/m3}"), "give how many times");
    contains(error(good, ", water: removed, sample: 3 ppm}}"), "expected what was in the sample");
    contains(error(good, ", water: removed, index: 1.1}}"), "index");
}

// 1 NTU is as much as scatters 1/m at 550 nm, or what the user says.
TEST(Turbidity, IsScatteringAt550Nanometres) {
    const WaterDesc desc = vsf_water(
        "{species: {clay: {library: clay}, harbor: {library: petzold-harbor, ntu: 0.5}}, "
        "particles: {clay: 4 NTU, harbor: 6 FNU}, bands: [550]}");
    const WaterModel model = build_water_model(desc, {});
    EXPECT_NEAR(total_scattering(model.medium.uniform, 0) - water_scattering(550, 35), 4 + 3, 1e-9);
    EXPECT_NEAR(concentration_of(desc.species[0], {0, 1, SpeciesAmount::Unit::ntu}, desc) *
                    species_optics(desc.species[0], 550, desc).scattering,
                1, 1e-12);
}

}  // namespace
}  // namespace uw
