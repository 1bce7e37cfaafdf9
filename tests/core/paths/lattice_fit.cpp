// ctest labels: unit analytic
#include "core/paths/lattice_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

namespace uw {
namespace {

constexpr int k_fit_radius = 8;

/// The nodes within the radius where `takes_part(dx, dy)`, the nearest first.
std::vector<FitNode> nodes_where(const std::function<bool(int, int)>& takes_part) {
    std::vector<FitNode> nodes;
    for (int y = -k_fit_radius; y <= k_fit_radius; ++y)
        for (int x = -k_fit_radius; x <= k_fit_radius; ++x)
            if (takes_part(x, y)) nodes.push_back({x, y});
    std::ranges::stable_sort(nodes, std::less(), [](const FitNode& node) {
        return node.dx * node.dx + node.dy * node.dy;
    });
    for (std::size_t i = 0; i < nodes.size(); ++i) nodes[i].index = i;
    return nodes;
}

double fitted(const std::vector<FitNode>& nodes, const std::function<double(int, int)>& value,
              int radius = k_fit_radius) {
    LatticeFit fit;
    EXPECT_TRUE(fit.fit(nodes, radius));
    double sum = 0, weights = 0;
    for (const FitWeight& weight : fit.weights()) {
        const FitNode& node = nodes[weight.index];
        sum += weight.weight * value(node.dx, node.dy);
        weights += weight.weight;
    }
    EXPECT_NEAR(weights, 1, 1e-9);  // rounding of the normal equations
    return sum;
}

bool everywhere(int, int) {
    return true;
}

TEST(LatticeFit, FollowsAQuadric) {
    const auto value = [](int x, int y) {
        return 3 + 0.2 * x - 0.1 * y + 0.03 * x * y - 0.02 * y * y;
    };
    EXPECT_NEAR(fitted(nodes_where(everywhere), value), 3, 1e-9);
    // A plane known on one side only is extrapolated exactly.
    const auto plane = [](int x, int y) { return 3 + 0.2 * x - 0.1 * y; };
    EXPECT_NEAR(fitted(nodes_where([](int x, int) { return x >= 0; }), plane), 3, 1e-9);
}

TEST(LatticeFit, AveragesNoiseOverTheNodes) {
    LatticeFit fit;
    ASSERT_TRUE(fit.fit(nodes_where(everywhere), k_fit_radius));
    double squares = 0;
    for (const FitWeight& weight : fit.weights()) squares += weight.weight * weight.weight;
    EXPECT_LT(squares, 1.0 / 20);  // that of more than a hundred nodes
}

TEST(LatticeFit, EndsAtTheRadius) {
    const auto step = [](int x, int y) { return x * x + y * y < 9 ? 1.0 : 100.0; };
    EXPECT_NEAR(fitted(nodes_where(everywhere), step, 2), 1, 1e-9);
    EXPECT_EQ(fitted(nodes_where(everywhere), step, 0), 1);
}

TEST(LatticeFit, WeightsTheNodes) {
    // Every other column has another value and a small weight.
    const auto value = [](int x, int) { return x % 2 == 0 ? 3.0 : 100.0; };
    std::vector<FitNode> nodes = nodes_where(everywhere);
    for (FitNode& node : nodes)
        if (node.dx % 2 != 0) node.weight = 1e-3;
    // Both have about the same total weight.
    EXPECT_NEAR(fitted(nodes, value), 3 + 97e-3, 0.03);
}

TEST(LatticeFit, UsesAsManyNodesAsThereAre) {
    LatticeFit fit;
    EXPECT_FALSE(fit.fit({}, k_fit_radius));
    const std::vector<FitNode> one{{5, -3, 0}};
    EXPECT_FALSE(fit.fit(one, 4));
    EXPECT_DOUBLE_EQ(fitted(one, [](int, int) { return 7.0; }), 7);
}

}  // namespace
}  // namespace uw
