// ctest labels: unit analytic
#include "media/water/tabulated_phase.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace uw {
namespace {

using SegmentLaw = PiecewiseFunction::Law;
constexpr double k_half_turn = std::numbers::pi;

TEST(PiecewiseFunction, FollowsEachSegmentsLaw) {
    const PiecewiseFunction f(
        {0, 0.1, 1, 2, k_half_turn}, {1, 5, 0.5, 0.05, 0},
        {SegmentLaw::linear, SegmentLaw::power, SegmentLaw::exponential, SegmentLaw::linear});
    EXPECT_NEAR(f.eval(0.05), 3, 1e-14);
    // 5 at 0.1 and 0.5 at 1: 0.5 psi^-1.
    for (const double psi : {0.1, 0.2, 0.5, 0.99}) EXPECT_NEAR(f.eval(psi), 0.5 / psi, 1e-13);
    // A tenth per radian.
    for (const double psi : {1.0, 1.3, 1.99})
        EXPECT_NEAR(f.eval(psi), 0.5 * std::pow(0.1, psi - 1), 1e-14);
    EXPECT_NEAR(f.eval(0.5 * (2 + k_half_turn)), 0.025, 1e-15);
    EXPECT_EQ(f.eval(k_half_turn), 0);
}

// 2 and 4 begin new exponents, by which segments are looked up.
TEST(PiecewiseFunction, EndsAtAPowerOfTwo) {
    for (const double end : {2.0, 4.0}) {
        const PiecewiseFunction f({0, 1, end}, {3, 2, 1}, {SegmentLaw::linear, SegmentLaw::linear});
        EXPECT_NEAR(f.eval(end), 1, 1e-15);
        EXPECT_NEAR(f.eval(0.5 * (1 + end)), 1.5, 1e-15);
    }
}

TEST(PiecewiseFunction, BeyondItsEndsIsTheNearerEnd) {
    const PiecewiseFunction f({0, 1, k_half_turn}, {3, 2, 1},
                              {SegmentLaw::linear, SegmentLaw::linear});
    EXPECT_EQ(f.eval(-1e-17), f.eval(0));
    EXPECT_EQ(f.eval(k_half_turn + 1e-15), f.eval(k_half_turn));
}

TEST(PiecewiseFunction, IntegratesOverTheSphere) {
    // 1 everywhere: 2 pi (cos a - cos b).
    const PiecewiseFunction one({0, 0.3, 1.1, k_half_turn}, {1, 1, 1, 1},
                                {SegmentLaw::linear, SegmentLaw::power, SegmentLaw::exponential});
    EXPECT_NEAR(one.integral(0, 3), 4 * k_half_turn, 1e-12);
    EXPECT_NEAR(one.integral(1, 2), 2 * k_half_turn * (std::cos(0.3) - std::cos(1.1)), 1e-12);
    // psi: 2 pi (sin psi - psi cos psi).
    const PiecewiseFunction angle({0, k_half_turn}, {0, k_half_turn}, {SegmentLaw::linear});
    EXPECT_NEAR(angle.integral(0, 1), 2 * k_half_turn * k_half_turn, 1e-11);
    // e^(m psi): 2 pi e^(m psi) (m sin psi - cos psi) / (m^2 + 1).
    const double m = -40;
    const PiecewiseFunction steep({0, k_half_turn}, {1, std::exp(m * k_half_turn)},
                                  {SegmentLaw::exponential});
    EXPECT_NEAR(steep.integral(0, 1),
                2 * k_half_turn * (1 + std::exp(m * k_half_turn)) / (m * m + 1), 1e-14);
}

TEST(PiecewiseFunction, IntegralsAdd) {
    const PiecewiseFunction f(
        {0, 1e-6, 1e-3, 0.2, k_half_turn}, {1e4, 1e4, 50, 1, 0.1},
        {SegmentLaw::linear, SegmentLaw::power, SegmentLaw::power, SegmentLaw::exponential});
    const double whole = f.integral(0, 4);
    double sum = 0;
    for (std::size_t i = 0; i < 4; ++i) sum += f.integral(i, i + 1);
    EXPECT_NEAR(sum, whole, 1e-13 * whole);
    EXPECT_EQ(f.integral(2, 2), 0);
}

TEST(PiecewiseFunction, ScalesValuesAndIntegralsAlike) {
    PiecewiseFunction f({0, 0.5, 1, k_half_turn}, {2, 1, 3, 0},
                        {SegmentLaw::exponential, SegmentLaw::power, SegmentLaw::linear});
    const double integral = f.integral(0, 3);
    const double values[] = {f.eval(0.2), f.eval(0.7), f.eval(2)};
    f.scale(1e-3);
    EXPECT_NEAR(f.integral(0, 3), 1e-3 * integral, 1e-15 * integral);
    EXPECT_NEAR(f.eval(0.2), 1e-3 * values[0], 1e-17);
    EXPECT_NEAR(f.eval(0.7), 1e-3 * values[1], 1e-17);
    EXPECT_NEAR(f.eval(2), 1e-3 * values[2], 1e-17);
}

TEST(PiecewiseFunction, FindsItsSegmentAmongMany) {
    // A thousand knots of a sawtooth, far denser than its table of buckets.
    std::vector<double> psi, value;
    for (int i = 0; i <= 1000; ++i) {
        psi.push_back(i == 1000 ? k_half_turn : k_half_turn * i / 1000);
        value.push_back(i % 2 == 0 ? 1 : 3);
    }
    const PiecewiseFunction f(psi, value, std::vector<SegmentLaw>(1000, SegmentLaw::linear));
    for (std::size_t i = 0; i < 1000; ++i) {
        EXPECT_NEAR(f.eval(psi[i]), value[i], 1e-9);
        EXPECT_NEAR(f.eval(0.5 * (psi[i] + psi[i + 1])), 2, 1e-9);
    }
    EXPECT_EQ(f.knots(), psi);
}

}  // namespace
}  // namespace uw
