// ctest labels: unit statistical
#include "core/paths/lattice_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

namespace uw {
namespace {

/// The nodes within the maximum radius with the value `value(dx, dy)`, where `takes_part(dx, dy)`.
std::vector<FitNode> nodes_of(
    const std::function<double(int, int)>& value, double variance,
    const std::function<bool(int, int)>& takes_part = [](int, int) { return true; }) {
    std::vector<FitNode> nodes;
    constexpr int k_max_radius = LatticeFit::k_max_radius;
    for (int y = -k_max_radius; y <= k_max_radius; ++y)
        for (int x = -k_max_radius; x <= k_max_radius; ++x)
            if (takes_part(x, y)) nodes.push_back({x, y, value(x, y), variance, nodes.size()});
    std::ranges::stable_sort(nodes, std::less(), [](const FitNode& node) {
        return node.dx * node.dx + node.dy * node.dy;
    });
    for (std::size_t i = 0; i < nodes.size(); ++i) nodes[i].index = i;
    return nodes;
}

double fitted(LatticeFit& fit, const std::vector<FitNode>& nodes, double tolerance = 0) {
    double sum = 0, weights = 0;
    fit.fit(nodes, tolerance);
    for (const FitWeight& weight : fit.weights()) {
        sum += weight.weight * nodes[weight.index].value;
        weights += weight.weight;
    }
    EXPECT_NEAR(weights, 1, 1e-9);  // rounding of the normal equations
    return sum;
}

TEST(LatticeFit, FollowsAQuadric) {
    LatticeFit fit;
    const auto value = [](int x, int y) {
        return 3 + 0.2 * x - 0.1 * y + 0.03 * x * y - 0.02 * y * y;
    };
    // The noise is so great that no fits differ: the widest is taken, which is exact.
    EXPECT_NEAR(fitted(fit, nodes_of(value, 100)), 3, 1e-9);
    EXPECT_LT(fit.variance(), 100.0 / 20);  // of more than a hundred nodes
    // A plane known on one side only is extrapolated exactly.
    const auto plane = [](int x, int y) { return 3 + 0.2 * x - 0.1 * y; };
    EXPECT_NEAR(fitted(fit, nodes_of(plane, 100, [](int x, int) { return x >= 0; })), 3, 1e-9);
}

TEST(LatticeFit, KeepsAStepThatIsGreaterThanTheNoise) {
    LatticeFit fit;
    const auto step = [](int x, int) { return x < 0 ? 10.0 : 0.0; };
    EXPECT_EQ(fitted(fit, nodes_of(step, 1e-4)), 0);
    // Noise far below the tolerance is not smoothed.
    EXPECT_EQ(fitted(fit, nodes_of(step, 1e-4), 100), 0);
    // Differences within the tolerance do not matter: this step is 9 times the noise, a third of
    // which remains in the next wider fit.
    const auto low = [](int x, int) { return x < 0 ? 0.09 : 0.0; };
    EXPECT_EQ(fitted(fit, nodes_of(low, 1e-4)), 0);
    EXPECT_GT(fitted(fit, nodes_of(low, 1e-4), 0.0195), 0.01);
}

TEST(LatticeFit, FitsWithinAGivenRadiusWhateverTheNodesShow) {
    LatticeFit fit;
    const auto step = [](int x, int) { return x < 0 ? 10.0 : 0.0; };
    const std::vector<FitNode> nodes = nodes_of(step, 1e-4);
    fit.fit(nodes, 0);
    EXPECT_LT(fit.radius(), LatticeFit::k_max_radius);
    fit.fit_within(nodes, LatticeFit::k_max_radius);
    EXPECT_EQ(fit.radius(), LatticeFit::k_max_radius);
    // The same as if noise had hidden the step.
    LatticeFit noisy;
    noisy.fit(nodes_of(step, 1e4), 0);
    ASSERT_EQ(fit.weights().size(), noisy.weights().size());
    for (std::size_t i = 0; i < fit.weights().size(); ++i)
        EXPECT_EQ(fit.weights()[i].weight, noisy.weights()[i].weight);
    EXPECT_EQ(fit.narrower().size(), noisy.narrower().size());
    fit.fit_within(nodes, 0);
    EXPECT_EQ(fit.radius(), 0);
    EXPECT_TRUE(fit.narrower().empty());
}

TEST(LatticeFit, WeightsTheNodes) {
    LatticeFit fit;
    // Every other column has another value and a small weight.
    const auto value = [](int x, int) { return x % 2 == 0 ? 3.0 : 100.0; };
    std::vector<FitNode> nodes = nodes_of(value, 1e4);
    for (FitNode& node : nodes)
        if (node.dx % 2 != 0) node.weight = 1e-3;
    // Both have about the same total weight.
    EXPECT_NEAR(fitted(fit, nodes), 3 + 97e-3, 0.03);
}

TEST(LatticeFit, StatesTheVarianceOfWhatItFits) {
    LatticeFit fit;
    std::mt19937 random(1);
    std::normal_distribution<double> noise;
    // One set of values decides on the neighbourhood, which is applied to another: they are
    // independent.
    double sum = 0, squares = 0, stated = 0;
    constexpr int k_trials = 2000;
    for (int trial = 0; trial < k_trials; ++trial) {
        const auto decides = nodes_of([&](int, int) { return noise(random); }, 1);
        double value = 0;
        fit.fit(decides, 0);
        for (const FitWeight& weight : fit.weights()) value += weight.weight * noise(random);
        sum += value;
        squares += value * value;
        stated += fit.variance();
    }
    // The variance of 2000 values is known to sqrt(2 / 2000) = 3 % if they are normally
    // distributed. The widths of the fits differ, which makes tails: four times that is allowed.
    // The mean: 4 standard errors.
    EXPECT_NEAR(squares / stated, 1, 0.13);
    EXPECT_LT(std::abs(sum), 4 * std::sqrt(stated));
    // The variance of a single node is 1, that of the widest fit 0.03; in one of eight cases noise
    // stops the widening earlier.
    EXPECT_LT(stated / k_trials, 0.25);
}

TEST(LatticeFit, UsesAsManyNodesAsThereAre) {
    LatticeFit fit;
    fit.fit({}, 0);
    EXPECT_TRUE(fit.weights().empty());
    EXPECT_EQ(fit.radius(), -1);
    const std::vector<FitNode> one{{5, -3, 7, 1, 0}};
    EXPECT_DOUBLE_EQ(fitted(fit, one), 7);
    EXPECT_DOUBLE_EQ(fit.variance(), 1);
}

}  // namespace
}  // namespace uw
