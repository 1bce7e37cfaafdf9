// ctest labels: unit analytic
#include "media/water/species.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/scene/dispersion.h"
#include "core/scene/scene_desc.h"
#include "media/inspection/water_table.h"
#include "media/water/mie.h"
#include "media/water/water_model.h"
#include "media/water/water_types.h"
#include "tests/support/message_of.h"
#include "tests/support/phase_function_laws.h"
#include "tests/support/scene_folder.h"

namespace uw {
namespace {

using namespace uw::test;

SpeciesDesc junge(double n, double min_um, double max_um, double exponent = 4) {
    SpeciesDesc species;
    species.name = "test";
    species.where = "scene.yaml:1:1: water.species.test";
    species.sizes.exponent = exponent;
    species.sizes.least = min_um * 1e-6;
    species.sizes.greatest = max_um * 1e-6;
    species.index.n = n;
    return species;
}

// The integral over sizes by Simpson's rule in the diameter itself, with the formula for b* written
// out: 1 ppm is 1e-6 of the volume.
TEST(Species, ScatteringIsTheIntegralOverSizes) {
    const SpeciesDesc species = junge(1.15, 0.4, 4);
    const double wavelength = 550, n_water = 1.34;
    double volume = 0, area = 0;
    constexpr int k_steps = 20000;
    for (int i = 0; i <= k_steps; ++i) {
        const double d = 0.4e-6 + (4e-6 - 0.4e-6) * i / k_steps;
        const double weight = (i == 0 || i == k_steps ? 1 : i % 2 == 1 ? 4 : 2) * std::pow(d, -4);
        const MieScattering mie(
            {std::numbers::pi * d * n_water / (wavelength * 1e-9), {1.15, 0}, {}});
        volume += weight * std::numbers::pi / 6 * d * d * d;
        area += weight * std::numbers::pi / 4 * d * d * mie.scattering_efficiency();
    }
    const SpeciesOptics optics = species_optics(species, wavelength, n_water);
    // The tolerance that species_optics states.
    EXPECT_NEAR(optics.scattering / (1e-6 * area / volume), 1, 1e-4);
    EXPECT_NEAR(optics.absorption / optics.scattering, 0, 1e-9);
}

TEST(Species, TablesHoldTheForwardPeak) {
    // Silt, clay, bubbles, and a coat: the table's integral is b.
    SpeciesDesc bubbles = junge(0.746, 20, 90);
    SpeciesDesc coated = bubbles;
    coated.coat = SpeciesDesc::Coat{0.1e-6, {1.2, 0, 0, {}}};
    for (const SpeciesDesc& species :
         {junge(1.152, 4, 63), junge(1.165, 0.2, 4), bubbles, coated}) {
        const SpeciesOptics optics = species_optics(species, 540, 1.34);
        const auto* phase = dynamic_cast<const SpeciesPhase*>(optics.phase.get());
        ASSERT_NE(phase, nullptr);
        // The table is that of amplitudes at angles, b comes from the coefficients of the series;
        // docs/water.md promises 1e-4.
        EXPECT_NEAR(1e-6 * phase->table_integral() / optics.scattering, 1, 1e-4);
        expect_phase_function_laws(*optics.phase);
    }
}

// Far from all ends, b* of Junge's distribution of exponent 4 scales: sizes and wavelength doubled
// give half of it, and the same phase function.
TEST(Species, DependsOnSizesByTheWavelength) {
    const SpeciesOptics one = species_optics(junge(1.1, 0.5, 20), 400, 1.34);
    const SpeciesOptics two = species_optics(junge(1.1, 1, 40), 800, 1.34);
    EXPECT_NEAR(two.scattering / one.scattering, 0.5, 1e-9);
    for (const double psi : {1e-4, 0.01, 0.1, 1.0, 3.0})
        EXPECT_NEAR(two.phase->eval(psi) / one.phase->eval(psi), 1, 1e-9) << psi;
}

// Kopelevich's small particles are minerals of index 1.15 and at most 1 um, his large ones organic,
// of 1.03 and 1 to 25 um (Mobley 1994, section 3.8). He does not print the sizes' distribution, but
// his b* must lie between those of the ends of each class.
TEST(Species, OfHisIndicesAndSizesEncloseKopelevichsParticles) {
    const auto b = [](double n, double diameter_um) {
        return species_optics(junge(n, 0.97 * diameter_um, 1.03 * diameter_um), 550, 1.34)
            .scattering;
    };
    EXPECT_LT(b(1.15, 0.2), kopelevich_small_scattering(550));
    EXPECT_GT(b(1.15, 1), kopelevich_small_scattering(550));
    EXPECT_GT(b(1.03, 5), kopelevich_large_scattering(550));
    EXPECT_LT(b(1.03, 25), kopelevich_large_scattering(550));
}

// With Junge's exponent of 4 over each class, the least of the small ones 0.1 um, they come to his
// particles: b* of the small ones to 5 %, of the large ones to 20 %; b_b/b of the tables (Mobley
// 1994: 0.039 and 0.00064) to 10 % and, of large spheres, half; and b's exponents of 1.7 and 0.3
// less well, as is known of spheres without absorption.
TEST(Species, OfHisClassesScatterAsKopelevichsParticles) {
    const SpeciesDesc small = junge(1.15, 0.1, 1), large = junge(1.03, 1, 25);
    const SpeciesOptics at_550 = species_optics(small, 550, 1.34);
    EXPECT_NEAR(at_550.scattering / kopelevich_small_scattering(550), 1, 0.05);
    EXPECT_NEAR(backscatter_fraction(*at_550.phase) / 0.039, 1, 0.1);
    const SpeciesOptics of_large = species_optics(large, 550, 1.34);
    EXPECT_NEAR(of_large.scattering / kopelevich_large_scattering(550), 1, 0.2);
    EXPECT_NEAR(backscatter_fraction(*of_large.phase) / 0.00064, 0.6, 0.2);
    const auto exponent = [](const SpeciesDesc& species) {
        return std::log(species_optics(species, 412, 1.34).scattering /
                        species_optics(species, 650, 1.34).scattering) /
               std::log(650.0 / 412);
    };
    EXPECT_NEAR(exponent(small), 1.7, 0.4);
    EXPECT_NEAR(exponent(large), 0.3, 0.8);
    EXPECT_GT(exponent(small), exponent(large) + 0.5);
}

TEST(Species, AmountsAreConcentrations) {
    SpeciesDesc species = junge(1.15, 10, 10.2);
    species.density = 2.5;
    const auto ppm = [&](double amount, SpeciesAmount::Unit unit) {
        return concentration_of(species, {0, amount, unit}, {});
    };
    EXPECT_DOUBLE_EQ(ppm(3, SpeciesAmount::Unit::own), 3);
    EXPECT_DOUBLE_EQ(ppm(5, SpeciesAmount::Unit::grams), 2);
    // A million spheres of about 10.1 um in diameter.
    EXPECT_NEAR(ppm(1e6, SpeciesAmount::Unit::number),
                1e12 * std::numbers::pi / 6 * std::pow(10.1e-6, 3), 1e-3 * 5.4e-4);
}

// The moments of the distributions in closed form: E[D^3] of a log-normal one is median^3
// e^(4.5 ln^2 sigma), of a gamma one (mode / exponent)^3 Gamma(exponent + 4) / Gamma(exponent + 1).
TEST(Species, MeanVolumesAreThoseOfTheDistributions) {
    const auto mean_volume = [](const SizesDesc& sizes) {
        SpeciesDesc species = junge(1.1, 1, 2);
        species.sizes = sizes;
        return concentration_of(species, {0, 1, SpeciesAmount::Unit::number}, {}) * 1e-6;
    };
    SizesDesc lognormal;
    lognormal.type = SizesDesc::Type::lognormal;
    lognormal.least = 1e-7;
    lognormal.greatest = 1e-4;
    lognormal.median = 2e-6;
    lognormal.sigma = 1.6;
    const double deviation = std::log(1.6);
    // Midpoints of 4096 intervals.
    EXPECT_NEAR(mean_volume(lognormal) / (std::numbers::pi / 6 * std::pow(2e-6, 3) *
                                          std::exp(4.5 * deviation * deviation)),
                1, 1e-5);
    SizesDesc gamma;
    gamma.type = SizesDesc::Type::gamma;
    gamma.least = 1e-8;
    gamma.greatest = 1e-4;
    gamma.exponent = 3;
    gamma.mode = 2e-6;
    EXPECT_NEAR(mean_volume(gamma) / (std::numbers::pi / 6 * std::pow(2e-6 / 3, 3) *
                                      std::tgamma(7.0) / std::tgamma(4.0)),
                1, 1e-5);
}

WaterDesc water(const std::string& text) {
    return read_water_overrides({"water=" + text});
}

SpeciesDesc lognormal(double median_um, double sigma, double n = 1.15) {
    return water(fmt::format("{{species: {{haze: {{size: {{type: lognormal, median: {} um, sigma: "
                             "{}}}, index: {}}}}}}}",
                             median_um, sigma, n))
        .species[0];
}

/// The share of the volume of a log-normal distribution below a diameter.
double volume_below(double diameter, double median, double sigma) {
    const double deviation = std::log(sigma);
    return 0.5 * std::erfc((3 * deviation - std::log(diameter / median) / deviation) /
                           std::numbers::sqrt2);
}

// Numbers are those of the whole distribution, whatever part of it has to be computed: the mean
// volume is pi/6 median^3 e^(4.5 ln^2 sigma), less what is smaller than 10 nm or larger than 5 mm.
TEST(Species, NumbersOfALognormalDistributionCountAllOfIt) {
    for (const double sigma : {1.02, 1.2, 1.8, 3.0, 5.0, 10.0})
        for (const double median : {0.01, 0.05, 2.0, 300.0, 5000.0}) {
            const SpeciesDesc species = lognormal(median, sigma);
            const double deviation = std::log(sigma);
            const double whole = std::numbers::pi / 6 * std::pow(median * 1e-6, 3) *
                                 std::exp(4.5 * deviation * deviation);
            const double share = volume_below(5e-3, median * 1e-6, sigma) -
                                 volume_below(10e-9, median * 1e-6, sigma);
            const double ppm = concentration_of(species, {0, 1e6, SpeciesAmount::Unit::number}, {});
            // What is beyond 4 deviations of the volume is left out.
            EXPECT_NEAR(ppm / (1e12 * whole), share, 1e-4 * share) << median << " " << sigma;
        }
}

// b of particles that are counted is the integral over f(D) dD with the whole of f, by Simpson's
// rule over 12 deviations about what scatters most, in ln D. Small particles scatter as D^6: of
// those of 20 nm nearly all is due to a few that are 10 times as large.
TEST(Species, NumbersScatterAsTheIntegralOverALognormalDistribution) {
    struct Sizes {
        double median_um, sigma;
    };
    for (const auto& [median, sigma] :
         {Sizes{0.02, 1.8}, Sizes{0.02, 3}, Sizes{0.3, 1.2}, Sizes{1, 1.8}, Sizes{1, 2.5}}) {
        const double deviation = std::log(sigma),
                     wave_number = 2 * std::numbers::pi * 1.34 / 550e-9;
        double sum = 0;
        constexpr int k_steps = 3000;
        const double first = std::log(10e-9),
                     last = std::log(median * 1e-6) + deviation * (6 * deviation + 6);
        const double end = std::min(last, std::log(200e-6)), step = (end - first) / k_steps;
        for (int i = 0; i <= k_steps; ++i) {
            const double x = first + i * step, d = std::exp(x);
            const double t = (x - std::log(median * 1e-6)) / deviation;
            const double density =
                std::exp(-t * t / 2) / (deviation * std::sqrt(2 * std::numbers::pi));
            const MieScattering mie({wave_number * d / 2, {1.15, 0}, {}});
            sum += (i == 0 || i == k_steps ? 1
                    : i % 2 == 1           ? 4
                                           : 2) *
                   step / 3 * density * std::numbers::pi / 4 * d * d * mie.scattering_efficiency();
        }
        const SpeciesDesc species = lognormal(median, sigma);
        const double ppm = concentration_of(species, {0, 1, SpeciesAmount::Unit::number}, {});
        // species_optics states 1e-4, as much again lies beyond the ends.
        EXPECT_NEAR(ppm * species_optics(species, 550, 1.34).scattering / sum, 1, 4e-4)
            << median << " um, " << sigma;
    }
}

// Where ends are given, numbers are those between them: the moments of the truncated distribution.
TEST(Species, NumbersBetweenEndsAreThoseOfTheTruncatedDistribution) {
    const auto mean_volume = [](const std::string& size) {
        const WaterDesc desc = water("{species: {a: {size: " + size + ", index: 1.1}}}");
        return 1e-6 * concentration_of(desc.species[0], {0, 1, SpeciesAmount::Unit::number}, {});
    };
    // By Simpson's rule in ln D, from 0.5 to 50 um.
    const auto truth = [](const auto& density) {
        constexpr int k_steps = 4000;
        double numbers = 0, volumes = 0;
        for (int i = 0; i <= k_steps; ++i) {
            const double d = 0.5e-6 * std::pow(100.0, static_cast<double>(i) / k_steps);
            const double weight = (i == 0 || i == k_steps ? 1
                                   : i % 2 == 1           ? 4
                                                          : 2) *
                                  density(d) * d;
            numbers += weight;
            volumes += weight * std::numbers::pi / 6 * d * d * d;
        }
        return volumes / numbers;
    };
    for (const double sigma : {1.02, 1.8, 3.0, 10.0})
        EXPECT_NEAR(mean_volume(fmt::format("{{type: lognormal, median: 2 um, sigma: {}, diameter: "
                                            "[0.5 um, 50 um]}}",
                                            sigma)) /
                        truth([&](double d) {
                            const double t = std::log(d / 2e-6) / std::log(sigma);
                            return std::exp(-t * t / 2) / d;
                        }),
                    1, 1e-4)
            << sigma;
    for (const double exponent : {0.0, 3.0, 4.0, 5.5})
        EXPECT_NEAR(mean_volume(fmt::format(
                        "{{type: junge, exponent: {}, diameter: [0.5 um, 50 um]}}", exponent)) /
                        truth([&](double d) { return std::pow(d, -exponent); }),
                    1, 1e-4)
            << exponent;
    for (const double exponent : {0.1, 3.0, 100.0})
        EXPECT_NEAR(
            mean_volume(fmt::format(
                "{{type: gamma, mode: 5 um, exponent: {}, diameter: [0.5 um, 50 um]}}", exponent)) /
                truth([&](double d) {
                    return std::exp(exponent * (std::log(d / 5e-6) - d / 5e-6 + 1));
                }),
            1, 1e-4)
            << exponent;
}

TEST(Species, WarnsOfTheVolumeThatSizesLeaveOut) {
    const auto warnings = [](const std::string& size) {
        return build_water_model(water("{species: {haze: {size: " + size +
                                       ", index: {n: 1.1, k: 1}}}, particles: {haze: 0.1}, "
                                       "bands: [550]}"),
                                 {})
            .warnings;
    };
    EXPECT_TRUE(warnings("{type: lognormal, median: 2 um, sigma: 1.8}").empty());
    EXPECT_TRUE(
        warnings("{type: lognormal, median: 12 nm, sigma: 1.5, diameter: [10 nm, 5 um]}").empty());
    const auto small = warnings("{type: lognormal, median: 12 nm, sigma: 1.2}");
    ASSERT_EQ(small.size(), 1U);
    EXPECT_NE(small[0].find(fmt::format("{:.2g} % of its volume is in particles smaller than 10 nm",
                                        100 * volume_below(10e-9, 12e-9, 1.2))),
              std::string::npos)
        << small[0];
    EXPECT_NE(small[0].find("water.species.haze"), std::string::npos) << small[0];
    const SpeciesDesc large = lognormal(1000, 2);
    const std::string text = sizes_warning(large).value_or("");
    EXPECT_NE(text.find(fmt::format("{:.2g} % of its volume is in particles larger than 5 mm",
                                    100 * (1 - volume_below(5e-3, 1e-3, 2)))),
              std::string::npos)
        << text;
    EXPECT_FALSE(sizes_warning(junge(1.1, 1, 10)));
}

// Junge's distribution of exponent 4 has the same volume in each class of a sizer; indices of a
// table are interpolated at the wavelength in vacuum.
TEST(Species, OfTablesAreThoseOfFormulas) {
    const SceneFolder folder;
    folder.write("sizes.csv", "diameter_um,volume\n1,3\n2,3\n10,3\n");
    folder.write("index.csv", "wavelength_nm,n,k\n500,1.14,0.001\n600,1.16,0.003\n");
    SpeciesDesc tables = junge(1, 1, 2);
    tables.sizes.type = SizesDesc::Type::table;
    tables.sizes.file = folder.path() / "sizes.csv";
    tables.index.file = folder.path() / "index.csv";
    SpeciesDesc formulas = junge(1.15, 1, 10);
    formulas.index.k = 0.002;
    const SpeciesOptics a = species_optics(tables, 550, 1.34);
    const SpeciesOptics b = species_optics(formulas, 550, 1.34);
    EXPECT_NEAR(a.scattering / b.scattering, 1, 1e-9);
    EXPECT_NEAR(a.absorption / b.absorption, 1, 1e-9);
    EXPECT_GT(b.absorption, 0.01 * b.scattering);
    // A file that has changed is read again.
    folder.write("index.csv", "wavelength_nm,n,k\n500,1.14,0\n600,1.16,0\n");
    EXPECT_LT(species_optics(tables, 550, 1.34).absorption, 1e-6 * b.absorption);
    folder.write("sizes.csv", "diameter_um,volume\n1,-3\n2,3\n");
    EXPECT_NE(message_of<InputError>([&] {
                  (void)species_optics(tables, 550, 1.34);
              }).find("scene.yaml:1:1: water.species.test: sizes.csv"),
              std::string::npos);
}

// The index's k falls by e^(-slope (lambda - 550 nm)). Weakly absorbing spheres, even the largest
// here (4 k x = 0.15 at most), absorb 4 pi k n_water / lambda of their volume, times a factor near
// n of refraction into them, which is the same at both wavelengths.
TEST(Species, OfTheLibraryAbsorbByTheWavelength) {
    const WaterDesc desc =
        water("{species: {d: {library: detritus}, s: {library: iron-sulphide}}}");
    const auto of = [&](std::size_t species, double nm) {
        return species_optics(desc.species[species], nm, 1.34);
    };
    const auto k = [](double nm) { return 0.75 * 0.010658 * std::exp(-0.007186 * nm); };
    const double blue = of(0, 450).absorption, red = of(0, 620).absorption;
    const double of_volume = 1e-6 * 4 * std::numbers::pi * k(450) * 1.34 / 450e-9;
    EXPECT_GT(blue / of_volume, 0.9);
    EXPECT_LT(blue / of_volume, 1.1);
    EXPECT_NEAR(blue / red / (k(450) / k(620) * 620 / 450), 1, 0.05);
    // What does not let light through absorbs about as much as it shadows, and scatters as much or
    // more: 3 / (2 D) per volume, where 1 / D is 2.75 / um in the mean over volumes ~ D^-2. Spheres
    // of some wavelengths do so within a factor of 1.5.
    const double shadow = 1.5 * 0.5 * (1 / 0.2 + 1 / 2.0);
    EXPECT_GT(of(1, 540).absorption, shadow / 1.5);
    EXPECT_LT(of(1, 540).absorption, shadow * 1.5);
    EXPECT_GT(of(1, 540).scattering, shadow / 1.5);
}

TEST(Species, AddToTheWaterInEachBand) {
    const WaterDesc desc = water(
        "{species: {silt: {library: clay}, haze: {size: {type: lognormal, median: 0.6 um, sigma: "
        "1.5}, index: {n: 1.1, k: 0.01}}}, particles: {silt: 5.3 g/m3, haze: 0.2}}");
    const WaterModel model = build_water_model(desc, {});
    const WaterModel plain = build_water_model(water("{}"), {});
    // Molecules, and two species in three bands.
    EXPECT_EQ(model.medium.phase_count(), 7);
    for (std::size_t i = 0; i < 3; ++i) {
        const double wavelength = desc.bands_nm[i];
        const double n = water_refractive_index(wavelength, 20, 35);
        const SpeciesOptics silt = species_optics(desc.species[0], wavelength, n);
        const SpeciesOptics haze = species_optics(desc.species[1], wavelength, n);
        EXPECT_NEAR(
            model.medium.uniform.total_scattering()[i] - plain.medium.uniform.total_scattering()[i],
            2 * silt.scattering + 0.2 * haze.scattering, 1e-12);
        EXPECT_NEAR(model.medium.uniform.absorption[i] - plain.medium.uniform.absorption[i],
                    0.2 * haze.absorption, 1e-12);
        EXPECT_GT(haze.absorption, 0);
    }
    const WaterTable table = tabulate_water(desc, {});
    ASSERT_EQ(table.uniform.parts.size(), 3U);
    EXPECT_EQ(table.uniform.parts[1].name, "silt");
    EXPECT_NEAR(table.uniform.scattering(2), model.medium.uniform.total_scattering()[2], 1e-12);
    EXPECT_NEAR(table.uniform.vsf(0, 0.3),
                model.medium.uniform.scattering[0][0] * model.medium.phase_functions[0]->eval(0.3) +
                    table.uniform.vsf(0, 1, 0.3) + table.uniform.vsf(0, 2, 0.3),
                1e-12);
}

// Two descriptions of the same water: Kopelevich's particles by the water's own keys, and as
// species.
TEST(Species, OfTheLibraryAreKopelevichsParticles) {
    const WaterDesc by_keys =
        water("{particles: {small: 0.3, large: 2, absorption: mineral}, bands: [650, 550, 412]}");
    const WaterDesc by_names = water(
        "{species: {fine: {library: kopelevich-small}, coarse: {library: kopelevich-large}}, "
        "particles: {fine: 0.3, coarse: 2 g/m3, absorption: mineral}, bands: [650, 550, 412]}");
    VolumeDesc of_keys;
    of_keys.grids.emplace_back().small_ppm = 1.5;
    of_keys.grids[0].large_ppm = 7;
    VolumeDesc of_names;
    of_names.grids.emplace_back().amounts = {{0, 3, SpeciesAmount::Unit::grams},
                                             {1, 7, SpeciesAmount::Unit::own}};
    const WaterModel keys = build_water_model(by_keys, {of_keys});
    const WaterModel names = build_water_model(by_names, {of_names});
    // Molecules and one phase function for each class, in all bands.
    ASSERT_EQ(keys.medium.phase_count(), 3);
    ASSERT_EQ(names.medium.phase_count(), 3);
    EXPECT_EQ(names.loads, keys.loads);
    EXPECT_GT(keys.medium.uniform.absorption[2], keys.medium.uniform.absorption[1]);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_DOUBLE_EQ(names.medium.uniform.absorption[i], keys.medium.uniform.absorption[i]);
        for (std::size_t m = 0; m < 3; ++m) {
            EXPECT_DOUBLE_EQ(names.medium.uniform.scattering[m][i],
                             keys.medium.uniform.scattering[m][i]);
            EXPECT_EQ(names.medium.phase_functions[m]->eval(0.2),
                      keys.medium.phase_functions[m]->eval(0.2));
        }
        EXPECT_DOUBLE_EQ(keys.medium.uniform.scattering[1][i],
                         0.3 * kopelevich_small_scattering(by_keys.bands_nm[i]));
        for (std::size_t k = 0; k < 2; ++k) {
            const OpticalCoefficients& a = names.medium.constituents[k].per_unit;
            const OpticalCoefficients& b = keys.medium.constituents[k].per_unit;
            EXPECT_DOUBLE_EQ(a.absorption[i], b.absorption[i]);
            EXPECT_DOUBLE_EQ(a.total_scattering()[i], b.total_scattering()[i]);
        }
    }
    EXPECT_EQ(names.medium.constituents[0].name, "fine");
    // 1 NTU scatters 1/m at 550 nm.
    EXPECT_DOUBLE_EQ(
        concentration_of(by_names.species[1], {1, 1, SpeciesAmount::Unit::ntu}, by_names),
        1 / kopelevich_large_scattering(550));
}

TEST(Species, OfGridsAreConstituentsPerPpm) {
    const WaterDesc desc = water("{species: {silt: {library: clay}}, particles: {small: 0.1}}");
    VolumeDesc volume;
    GridMappingDesc& grid = volume.grids.emplace_back();
    grid.grid = "density";
    grid.amounts = {{0, 5.3, SpeciesAmount::Unit::grams}};
    const WaterModel model = build_water_model(desc, {volume});
    ASSERT_EQ(model.medium.constituents.size(), 1U);
    const Constituent& silt = model.medium.constituents[0];
    EXPECT_EQ(silt.name, "silt");
    ASSERT_EQ(model.loads[0][0].size(), 1U);
    EXPECT_DOUBLE_EQ(model.loads[0][0][0].per_unit, 2);  // 5.3 g/m3 of 2.65 g/cm3
    for (std::size_t i = 0; i < 3; ++i) {
        const double nm = desc.bands_nm[i];
        const SpeciesOptics optics =
            species_optics(desc.species[0], nm, water_refractive_index(nm, 20, 35));
        EXPECT_NEAR(silt.per_unit.total_scattering()[i], optics.scattering, 1e-12);
        // Each band has the phase function of its own wavelength.
        double beta = 0;
        for (std::size_t m = 0; m < model.medium.phase_functions.size(); ++m)
            beta += silt.per_unit.scattering[m][i] * model.medium.phase_functions[m]->eval(0.5);
        EXPECT_NEAR(beta, optics.scattering * optics.phase->eval(0.5), 1e-12);
    }
}

TEST(Species, ErrorsSayWhatIsWrong) {
    const auto error = [](const std::string& text) {
        return message_of<InputError>([&] { (void)water(text); });
    };
    EXPECT_NE(error("{species: {mud: {library: clai}}}").find("did you mean 'clay'"),
              std::string::npos);
    EXPECT_NE(error("{species: {mud: {index: 1.1}}}").find("size"), std::string::npos);
    EXPECT_NE(error("{species: {small: {library: clay}}}").find("a meaning of its own"),
              std::string::npos);
    EXPECT_NE(error("{species: {a: {size: {type: junge, diameter: [1 um, 2 um]}, index: 1.1}}, "
                    "particles: {a: 3 g/m3}}")
                  .find("no density"),
              std::string::npos);
    EXPECT_NE(
        error("{species: {a: {library: kopelevich-small}}, particles: {a: 1e6 /m3}}").find("ppm"),
        std::string::npos);
    EXPECT_NE(error("{species: {a: {library: kopelevich-small, index: 1.1}}}")
                  .find("not used by a species of Kopelevich's"),
              std::string::npos);
    EXPECT_NE(error("{species: {a: {library: clay}}, particles: {a: 3 kg}}")
                  .find("expected a concentration"),
              std::string::npos);
    EXPECT_NE(error("{species: {a: {library: clay}}, particles: {b: 3}}").find("unknown key"),
              std::string::npos);
}

// The terms of each size are its orders, about 2 pi r / lambda of them, times the angles: a sum
// over the sizes that there may be.
TEST(Species, WorkIsCounted) {
    const WaterDesc water;
    constexpr double k_nm = 550, k_index = 1.336;
    const auto sum_of_orders = [&](const SpeciesDesc& species) {
        constexpr int k_sizes = 2048;
        const double ratio = species.sizes.greatest / species.sizes.least;
        double orders = 0;
        for (int i = 0; i < k_sizes; ++i) {
            const double diameter = species.sizes.least * std::pow(ratio, (i + 0.5) / k_sizes);
            orders += std::numbers::pi * diameter * k_index / (k_nm * 1e-9);
        }
        return orders;
    };
    // Some hundred angles, the more the narrower the forward peak is.
    double before = 200;
    for (const double max_um : {50.0, 500.0, 5000.0}) {
        const SpeciesDesc species = junge(1.1, 0.5, max_um);
        const double angles = species_work(species, k_nm, water) / sum_of_orders(species);
        EXPECT_GT(angles, before) << max_um;
        EXPECT_LT(angles, 1000) << max_um;
        before = angles;
    }
    SpeciesDesc measured = junge(1.1, 1, 50);
    measured.kopelevich = KopelevichClass::small;
    EXPECT_EQ(species_work(measured, k_nm, water), 0);
}

// What would take hours is refused before any of it is computed, wherever the species is used.
TEST(Species, AreRefusedWhereTheyWouldTakeHours) {
    std::string bands = "[400";
    for (int nm = 408; nm < 656; nm += 8) bands += ", " + std::to_string(nm);
    for (const char* const size : {"{type: lognormal, median: 5 mm, sigma: 1.02}",
                                   "{type: gamma, mode: 4 mm, diameter: [3 mm, 5 mm]}",
                                   "{type: junge, diameter: [4.9 mm, 5 mm]}"}) {
        const std::string text = std::string("{species: {stones: {size: ") + size +
                                 ", index: 1.15}}, particles: {stones: 1}, bands: " + bands + "]}";
        const std::string message =
            message_of<InputError>([&] { (void)build_water_model(water(text), {}); });
        EXPECT_NE(message.find("water.species.stones: to compute the species takes "),
                  std::string::npos)
            << message;
        EXPECT_NE(message.find("most of it stones; give smaller greatest diameters"),
                  std::string::npos)
            << message;
    }
    // One that nothing has costs nothing.
    const std::string unused =
        "{species: {stones: {size: {type: junge, diameter: [4 mm, 5 mm]}, index: 1.15}}, bands: " +
        bands + "]}";
    EXPECT_NO_THROW((void)build_water_model(water(unused), {}));
}

}  // namespace
}  // namespace uw
