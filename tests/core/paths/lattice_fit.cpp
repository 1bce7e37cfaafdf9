// ctest labels: unit statistical
#include "core/paths/lattice_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

namespace uw {
namespace {

/// The nodes within reach whose value is `value(dx, dy)`, where `takes_part(dx, dy)`.
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
    for (const FitWeight& weight : fit.fit(nodes, tolerance)) {
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
    // Noise so great that nothing is found to differ: the widest fit, which is exact.
    EXPECT_NEAR(fitted(fit, nodes_of(value, 100)), 3, 1e-9);
    EXPECT_LT(fit.variance(), 100.0 / 20);  // of more than a hundred nodes
    // A plane from one side only: extrapolated, also exactly.
    const auto plane = [](int x, int y) { return 3 + 0.2 * x - 0.1 * y; };
    EXPECT_NEAR(fitted(fit, nodes_of(plane, 100, [](int x, int) { return x >= 0; })), 3, 1e-9);
}

TEST(LatticeFit, KeepsAStepThatIsGreaterThanTheNoise) {
    LatticeFit fit;
    const auto step = [](int x, int) { return x < 0 ? 10.0 : 0.0; };
    EXPECT_EQ(fitted(fit, nodes_of(step, 1e-4)), 0);
    // Noise that is far less than what matters is left as it is.
    EXPECT_EQ(fitted(fit, nodes_of(step, 1e-4), 100), 0);
    // Differences within the tolerance do not matter: this step is 16 times the noise, of which a
    // third shows in the next wider fit.
    const auto low = [](int x, int) { return x < 0 ? 0.16 : 0.0; };
    EXPECT_EQ(fitted(fit, nodes_of(low, 1e-4)), 0);
    EXPECT_GT(fitted(fit, nodes_of(low, 1e-4), 0.0195), 0.01);
}

TEST(LatticeFit, ListensToNodesByTheirWeights) {
    LatticeFit fit;
    // Every other column tells something else, and counts little.
    const auto value = [](int x, int) { return x % 2 == 0 ? 3.0 : 100.0; };
    std::vector<FitNode> nodes = nodes_of(value, 1e4);
    for (FitNode& node : nodes)
        if (node.dx % 2 != 0) node.weight = 1e-3;
    // About as many of either.
    EXPECT_NEAR(fitted(fit, nodes), 3 + 97e-3, 0.03);
}

TEST(LatticeFit, StatesTheVarianceOfWhatItFits) {
    LatticeFit fit;
    std::mt19937 random(1);
    std::normal_distribution<double> noise;
    // Decided by one set of values, applied to another: independent of each other.
    double sum = 0, squares = 0, stated = 0;
    constexpr int k_trials = 2000;
    for (int trial = 0; trial < k_trials; ++trial) {
        const auto decides = nodes_of([&](int, int) { return noise(random); }, 1);
        double value = 0;
        for (const FitWeight& weight : fit.fit(decides, 0)) value += weight.weight * noise(random);
        sum += value;
        squares += value * value;
        stated += fit.variance();
    }
    // The variance of 2000 values is known to sqrt(2 / 2000) = 3 % if they are normal; widths of
    // the fit differ, which makes tails: four times that. The mean: 4 standard errors.
    EXPECT_NEAR(squares / stated, 1, 0.13);
    EXPECT_LT(std::abs(sum), 4 * std::sqrt(stated));
    // A single node has 1, the widest fit 0.03; noise stops the fit before that in one of eight
    // cases.
    EXPECT_LT(stated / k_trials, 0.25);
}

TEST(LatticeFit, TakesWhatNodesThereAre) {
    LatticeFit fit;
    EXPECT_TRUE(fit.fit({}, 0).empty());
    const std::vector<FitNode> one{{5, -3, 7, 1, 0}};
    EXPECT_DOUBLE_EQ(fitted(fit, one), 7);
    EXPECT_DOUBLE_EQ(fit.variance(), 1);
}

}  // namespace
}  // namespace uw
