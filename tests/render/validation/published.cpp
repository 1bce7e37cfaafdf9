// ctest labels: analytic
// What others have published: a canonical problem of ocean optics with few rays, and the rest.
#include "render/validation/published.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

#include "media/water/tabulated_phase.h"
#include "render/validation/light_trial.h"
#include "render/validation/published_tables.h"

namespace uw::test {
namespace {

void expect_passed(const std::vector<PublishedFigure>& figures) {
    for (const PublishedFigure& figure : figures)
        EXPECT_TRUE(figure.passed()) << figure.source << ": " << figure.quantity << ": "
                                     << figure.ours << " for " << figure.published;
}

// Sun, refraction, single and multiple scattering of particles, and what the surface reflects
// back: without that irradiance at albedo 0.9 is 2 to 4 % low.
TEST(Published, CanonicalProblemOfParticlesHolds) {
    const std::vector<PublishedFigure> figures =
        compare_with_published({.rays = 16384, .only = "problem 2"}).figures;
    expect_passed(figures);
    int irradiances = 0;
    for (const PublishedFigure& figure : figures) {
        if (!figure.quantity.starts_with("Ed")) continue;
        EXPECT_LT(figure.error, 0.04) << figure.quantity;  // ten optical depths down
        ++irradiances;
    }
    EXPECT_EQ(irradiances, 6);
}

// The largest k for which (1 - k cos) L = albedo / 2 * (phase function on L) has a solution L >= 0
// (Mobley 1994, "Light and Water", section 9.6), by its Legendre moments: the recurrence of L's
// moments is a symmetric tridiagonal matrix with the greatest eigenvalue 1/k.
double asymptotic_k(double albedo) {
    const CsvTable table = published_table("mobley1993_table2_phase.csv");
    const TabulatedPhase phase(table.curve("angle_deg", "phase"), "phase");
    constexpr std::size_t k_moments = 200;
    std::vector<double> moments(k_moments);
    // Steps that grow with the angle, as the peak is a tenth of a degree wide.
    constexpr int k_steps = 20000;
    for (int i = 0; i < k_steps; ++i) {
        const double t = (i + 0.5) / k_steps;
        const double angle = std::numbers::pi * t * t * t;
        const double cosine = std::cos(angle);
        const double weight = 2 * std::numbers::pi * std::sin(angle) * phase.eval(angle) * 3 *
                              std::numbers::pi * t * t / k_steps;
        double before = 1, here = cosine;
        moments[0] += weight;
        for (std::size_t n = 1; n < k_moments; ++n) {
            moments[n] += weight * here;
            const auto order = static_cast<double>(n);
            before = std::exchange(
                here, ((2 * order + 1) * cosine * here - order * before) / (order + 1));
        }
    }
    EXPECT_NEAR(moments[0], 1, 1e-3);
    const auto diagonal = [&](std::size_t n) {
        return static_cast<double>(2 * n + 1) * (1 - albedo * moments[n] / moments[0]);
    };
    // Sturm: below the least k, no leading minor of (diagonal - k J) is negative.
    double least = 0, most = 1;
    while (most - least > 1e-9) {
        const double k = (least + most) / 2;
        double pivot = diagonal(0);
        bool is_positive = true;
        for (std::size_t n = 1; n < k_moments && is_positive; ++n) {
            pivot = diagonal(n) - std::pow(k * static_cast<double>(n), 2) / pivot;
            is_positive = pivot > 0;
        }
        (is_positive ? least : most) = k;
    }
    return least;
}

// Published as a range; the transport equation's eigenvalue is exact.
TEST(Published, IrradianceFallsInTheEndAsTheTransportEquationHasIt) {
    const std::vector<PublishedFigure> figures =
        compare_with_published({.rays = 16384, .only = "asymptotic K"}).figures;
    ASSERT_EQ(figures.size(), 2U);
    expect_passed(figures);
    const std::array k_albedos{0.9, 0.2};
    for (std::size_t i = 0; i < 2; ++i) {
        const double exact = asymptotic_k(k_albedos[i]);
        EXPECT_NEAR(exact, figures[i].published, figures[i].spread * figures[i].published);
        // At albedo 0.2 the next solution falls only 0.05/m faster, and is still 1 % at work.
        EXPECT_NEAR(figures[i].ours / exact, 1, 0.01 + 3 * figures[i].error);
        EXPECT_LT(figures[i].error, 0.05);
    }
}

// The noise floor of the corners.
TEST(Published, CornersInPhotographsAreWherePortsPutThem) {
    const PublishedComparison comparison = compare_with_published({.only = "photographs"});
    ASSERT_EQ(comparison.figures.size(), 6U);
    expect_passed(comparison.figures);
    EXPECT_TRUE(comparison.passed());
    ASSERT_EQ(comparison.photographs.size(), 3U);
    for (const PublishedFigure& figure : comparison.figures) {
        if (!figure.is_bound) continue;
        // Much less would be other corners.
        EXPECT_GT(figure.ours, 0.95 * figure.published) << figure.source;
    }
    for (const PortPhotographs& set : comparison.photographs) {
        EXPECT_EQ(set.port.size(), set.plain.size());
        // Poses are free without the port, and still no pose makes up for it.
        EXPECT_GT(rms_of(set.plain), 1.15 * rms_of(set.port)) << set.source;
    }
}

TEST(Published, MeasuredWatersAndCyclesAgree) {
    const std::vector<PublishedFigure> waters = compare_with_published({.only = "Petzold"}).figures;
    EXPECT_EQ(waters.size(), 3U);
    expect_passed(waters);
    const std::vector<PublishedFigure> cycles = compare_with_published({.only = "Cycles"}).figures;
    EXPECT_EQ(cycles.size(), 7U);
    expect_passed(cycles);
    // Cycles' own error against tables by quadrature of the same (lamp_table).
    for (const PublishedFigure& figure : cycles) {
        for (const LampTableRow& row : lamp_table()) {
            if (figure.quantity != fmt::format("radiance {:g} m from a lamp, {:g} degrees aside",
                                               row.distance, row.angle))
                continue;
            EXPECT_NEAR(figure.published / row.total, 1, 3 * figure.spread) << figure.quantity;
        }
    }
}

TEST(PublishedFigure, PassesWithinToleranceAndTwoErrors) {
    PublishedFigure figure;
    figure.published = 2;
    figure.ours = 2.05;
    figure.tolerance = 0.01;
    EXPECT_FALSE(figure.passed());
    figure.error = 0.01;
    EXPECT_TRUE(figure.passed());
    figure.ours = 1;
    EXPECT_FALSE(figure.passed());
    figure.is_bound = true;
    EXPECT_TRUE(figure.passed());
}

}  // namespace
}  // namespace uw::test
