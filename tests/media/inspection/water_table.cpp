// ctest labels: unit analytic
#include "media/inspection/water_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/base/csv_table.h"
#include "media/water/molecular_phase.h"
#include "media/water/tabulated_phase.h"
#include "media/water/water_types.h"
#include "tests/support/adaptive_quadrature.h"
#include "tests/support/described_phase.h"
#include "tests/support/water_descs.h"

namespace uw {
namespace {

using namespace test;

using std::numbers::pi;
constexpr double k_radians_per_degree = pi / 180;

/// Particles of both kinds in sea water, as in figure 4 of the paper.
WaterDesc figure_water() {
    WaterDesc water = basic_water();
    water.bands_nm = {550, 440};
    water.small_ppm = 0.03;
    water.large_ppm = 0.05;
    return water;
}

void expect_same_coefficients(const CoefficientTable& table, const OpticalCoefficients& x,
                              const Medium& medium) {
    for (std::size_t i = 0; i < medium.wavelengths_nm.size(); ++i) {
        EXPECT_DOUBLE_EQ(table.absorption[i], x.absorption[i]);
        EXPECT_DOUBLE_EQ(table.scattering(i), total_scattering(x, i));
        EXPECT_DOUBLE_EQ(table.attenuation(i), x.attenuation(static_cast<int>(i)));
        for (const double angle : {0.0, 0.3, 20.0, 90.0, 180.0})
            EXPECT_DOUBLE_EQ(table.vsf(i, angle * k_radians_per_degree),
                             vsf(medium, x, i, angle * k_radians_per_degree));
    }
}

// Whatever the parts are, they add up to the medium that renders are made of.
TEST(WaterTable, PartsSumToTheMedium) {
    WaterDesc water = figure_water();
    water.bands_nm = {620, 540, 450};
    water.preset = "jerlov-III";
    water.mineral_absorption = true;
    const std::vector<VolumeDesc> volumes{
        volume_of({particle_grid("density", 1, 10),
                   optics_grid("sediment", {0.1, 0.2, 0.3}, {1, 2, 0}, hg(0.8)),
                   optics_grid("dye", {1, 1, 1}, {0.5, 0.5, 0.5}, std::nullopt)})};
    const WaterModel model = build_water_model(water, volumes);
    const WaterTable table = tabulate_water(water, volumes);
    EXPECT_TRUE(is_given_per_band(water, volumes));
    expect_same_coefficients(table.uniform, model.medium.uniform, model.medium);
    ASSERT_EQ(table.constituents.size(), 4U);
    for (std::size_t k = 0; k < 4; ++k) {
        const Constituent& constituent = model.medium.constituents[k];
        EXPECT_EQ(table.constituents[k].name, constituent.name);
        EXPECT_EQ(table.constituents[k].unit, constituent.unit);
        expect_same_coefficients(table.constituents[k], constituent.per_unit, model.medium);
    }
    ASSERT_EQ(table.uniform.parts.size(), 3U);
    EXPECT_EQ(table.uniform.parts[0].name, "water");
    EXPECT_EQ(table.uniform.parts[1].name, "small");
    EXPECT_EQ(table.uniform.parts[2].name, "large");
    EXPECT_EQ(table.small_ppm, 0.03);
}

// The figure's components by physics section 1: beta_w(90 deg) (1 + 0.835 cos^2 psi), and the
// printed tables times ppm times (550 nm / lambda)^k, scaled so that they integrate to 1.34 and
// 0.312. What the tables integrate to by their interpolation rules, 1.3247 and 0.31027, is known
// to five digits: hence 1e-4.
TEST(WaterTable, ComponentsOfFigure4) {
    const WaterTable table = tabulate_water(figure_water(), {});
    const CsvTable kopelevich = read_embedded_table("kopelevich_vsf.csv");
    const SampledCurve small = kopelevich.curve("angle_deg", "beta_s_small");
    const SampledCurve large = kopelevich.curve("angle_deg", "beta_l_large");
    ASSERT_EQ(small.x.size(), 19U);
    for (std::size_t i = 0; i < 2; ++i) {
        const double nm = table.wavelengths_nm[i];
        const double scale_small = 0.03 * std::pow(550 / nm, 1.7) * 1.34 / 1.3247;
        const double scale_large = 0.05 * std::pow(550 / nm, 0.3) * 0.312 / 0.31027;
        EXPECT_DOUBLE_EQ(table.uniform.vsf(i, 0, pi / 2), water_vsf_90(nm, 35));
        for (std::size_t k = 0; k < small.x.size(); ++k) {
            const double psi = small.x[k] * k_radians_per_degree;
            const double water = 1.38e-4 * (1 + 0.3 * 35 / 37) * std::pow(500 / nm, 4.32) *
                                 (1 + 0.835 * std::cos(psi) * std::cos(psi));
            const double s = scale_small * small.y[k], l = scale_large * large.y[k];
            EXPECT_NEAR(table.uniform.vsf(i, 0, psi), water, 1e-12 * water) << small.x[k];
            EXPECT_NEAR(table.uniform.vsf(i, 1, psi), s, 1e-4 * s) << small.x[k];
            EXPECT_NEAR(table.uniform.vsf(i, 2, psi), l, 1e-4 * l) << small.x[k];
            EXPECT_NEAR(table.uniform.vsf(i, psi), water + s + l, 1e-4 * (water + s + l));
        }
    }
}

// More wavelengths than a medium has bands are the same numbers, one by one.
TEST(WaterTable, AnyNumberOfWavelengths) {
    WaterDesc water = figure_water();
    water.preset = "jerlov-IB";
    water.bands_nm.clear();
    for (int nm = 400; nm <= 700; nm += 4) water.bands_nm.push_back(nm);
    const std::vector<VolumeDesc> volumes{volume_of({particle_grid("density", 0, 10)})};
    EXPECT_FALSE(is_given_per_band(water, volumes));
    const WaterTable all = tabulate_water(water, volumes);
    ASSERT_EQ(all.wavelengths_nm.size(), 76U);
    ASSERT_EQ(all.uniform.parts.size(), 3U);
    for (const std::size_t i : {0U, 31U, 32U, 50U, 75U}) {
        WaterDesc one = water;
        one.bands_nm = {water.bands_nm[i]};
        const WaterTable single = tabulate_water(one, volumes);
        EXPECT_DOUBLE_EQ(all.uniform.absorption[i], single.uniform.absorption[0]);
        for (std::size_t part = 0; part < 3; ++part)
            EXPECT_DOUBLE_EQ(all.uniform.parts[part].b[i], single.uniform.parts[part].b[0]);
        EXPECT_DOUBLE_EQ(all.constituents[0].attenuation(i), single.constituents[0].attenuation(0));
    }
    EXPECT_FALSE(all.warnings.empty());  // jerlov-IB was measured from 412 nm

    water.absorption = PerBand(76, 0.1);
    EXPECT_THROW(tabulate_water(water, volumes), InputError);
}

// Closed forms: Henyey-Greenstein's mean cosine is g and its backscatter fraction
// (1-g)/(2g) ((1+g)/sqrt(1+g^2) - 1); molecules scatter evenly. 1e-11: four-point Gauss rules on
// panels where p varies by a small factor.
TEST(WaterTable, MomentsOfClosedForms) {
    for (const double g : {-0.9, -0.3, 0.2, 0.5, 0.8, 0.924, 0.99, 0.999}) {
        const auto phase = henyey_greenstein(g);
        const PhaseFunction& p = *phase;
        const double back = (1 - g) / (2 * g) * ((1 + g) / std::sqrt(1 + g * g) - 1);
        EXPECT_NEAR(backscatter_fraction(p), back, 1e-11) << g;
        EXPECT_NEAR(mean_cosine(p), g, 1e-11) << g;
    }
    EXPECT_NEAR(backscatter_fraction(MolecularPhase()), 0.5, 1e-12);
    EXPECT_EQ(mean_cosine(MolecularPhase()), 0);
}

// Tables against a quadrature of the test's own; Petzold's fraction is published as 0.0183
// (Mobley, Gentili and Stavn 1993).
TEST(WaterTable, MomentsOfTables) {
    const auto quadrature = [](const PhaseFunction& p, double from) {
        double sum = 0;
        std::vector<double> edges{from};
        for (const double at : p.breakpoints())
            if (at > from) edges.push_back(at);
        edges.push_back(pi);
        for (std::size_t i = 0; i + 1 < edges.size(); ++i)
            sum += AdaptiveQuadrature::integrate(
                [&](double psi) {
                    return 2 * pi * p.eval(psi) * std::sin(psi) * (from > 0 ? 1.0 : std::cos(psi));
                },
                edges[i], edges[i + 1], 1e-12);
        return sum;
    };
    const auto check = [&](const PhaseFunction& p) {
        EXPECT_NEAR(backscatter_fraction(p), quadrature(p, pi / 2), 1e-9) << p.description();
        EXPECT_NEAR(mean_cosine(p), quadrature(p, 0), 1e-9) << p.description();
    };
    check(KopelevichSmall());
    check(KopelevichLarge());
    check(*petzold_average());
    check(*fournier_forand(1.1, 3.5835));
    EXPECT_NEAR(backscatter_fraction(*petzold_average()), 0.0183, 2e-4);
}

TEST(WaterTable, RatiosOfNothingHaveNoValue) {
    WaterDesc water = basic_water();
    water.absorption = PerBand{0, 1, 1};
    water.scattering = ScatteringDesc{{0, 0, 3}, hg(0.9)};
    const WaterTable table = tabulate_water(water, {});
    EXPECT_TRUE(std::isnan(table.uniform.albedo(0)));
    EXPECT_TRUE(std::isnan(table.uniform.backscatter_fraction(1)));
    EXPECT_TRUE(std::isnan(table.uniform.mean_cosine(1)));
    EXPECT_EQ(table.uniform.albedo(1), 0);
    EXPECT_DOUBLE_EQ(table.uniform.albedo(2), 0.75);
    EXPECT_NEAR(table.uniform.mean_cosine(2), 0.9, 1e-9);
}

}  // namespace
}  // namespace uw
