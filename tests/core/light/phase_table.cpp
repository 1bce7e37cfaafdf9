// ctest labels: unit
// The integrators' table of phase functions against the functions themselves.
#include "core/light/medium.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "media/water/molecular_phase.h"
#include "tests/support/described_phase.h"

namespace uw::test {
namespace {

Medium medium_of(std::vector<std::shared_ptr<const PhaseFunction>> phases) {
    Medium medium;
    medium.phase_functions = std::move(phases);
    return medium;
}

// Whether a bend of p lies within one cell (2^(1/64)) of tan(psi / 2).
bool bends_near(const PhaseFunction& phase, double half_tangent) {
    for (const double psi : phase.breakpoints())
        if (std::abs(std::log2(std::tan(0.5 * psi) / half_tangent)) < 1.0 / 32) return true;
    return false;
}

TEST(PhaseTable, EqualsEachFunctionButForTheCellsInWhichItBends) {
    const Medium medium =
        medium_of({std::make_shared<MolecularPhase>(), std::make_shared<KopelevichSmall>(),
                   std::make_shared<KopelevichLarge>(), test::petzold_average(),
                   test::henyey_greenstein(0.924), test::henyey_greenstein(-0.99),
                   test::fournier_forand(1.1, 3.5835)});
    const PhaseTable table(medium);
    const std::size_t phases = medium.phase_functions.size();
    std::vector<double> half_tangents;
    for (double octave = -20; octave < 13; octave += 0.0137)
        half_tangents.push_back(std::exp2(octave));
    std::vector<double> p(phases * half_tangents.size());
    table.eval(half_tangents, p);
    for (std::size_t m = 0; m < phases; ++m) {
        const PhaseFunction& phase = *medium.phase_functions[m];
        double worst = 0, worst_at_bends = 0;
        for (std::size_t i = 0; i < half_tangents.size(); ++i) {
            const double truth = phase.eval(2 * std::atan(half_tangents[i]));
            const double error = std::abs(p[m * half_tangents.size() + i] / truth - 1);
            double& of_kind = bends_near(phase, half_tangents[i]) ? worst_at_bends : worst;
            of_kind = std::max(of_kind, error);
        }
        // A parabola through three points h / 2 apart misses by h^3 p''' / (72 sqrt 3), with p as
        // steep as the inverse fourth power of the angle and h = 1/64.
        EXPECT_LT(worst, 4e-6) << phase.description();
        EXPECT_LT(worst_at_bends, 5e-3) << phase.description();
    }
}

TEST(PhaseTable, HoldsTheEndsOfTheRange) {
    const KopelevichLarge phase;
    const PhaseTable table(medium_of({std::make_shared<KopelevichLarge>()}));
    const std::vector<double> ends{0, 1e-30, 1e30, std::numeric_limits<double>::infinity()};
    std::vector<double> p(4);
    table.eval(ends, p);
    EXPECT_NEAR(p[0], phase.eval(0), 1e-4 * p[0]);  // 1e-6 rad from it
    EXPECT_EQ(p[1], p[0]);
    EXPECT_NEAR(p[2], phase.eval(std::numbers::pi), 1e-3 * p[2]);  // 1e-4 rad from it
    EXPECT_EQ(p[3], p[2]);
}

TEST(PhaseTable, WaterThatScattersNothingHasNone) {
    const PhaseTable table(medium_of({}));
    const std::vector<double> half_tangents{0.0, 1.0};
    std::vector<double> p;
    table.eval(half_tangents, p);
    EXPECT_TRUE(p.empty());
}

}  // namespace
}  // namespace uw::test
