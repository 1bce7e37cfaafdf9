// ctest labels: unit analytic
#include "core/paths/node_smoothing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace uw {
namespace {

constexpr int k_smoothed_nodes = 25, k_middle_node = k_smoothed_nodes / 2;

/// The smoothed light on a surface all over a lattice of nodes, at its middle, whose nodes have
/// `light(dx, dy)` in both halves of their paths, with a standard deviation of 0.1.
double smoothed_in_the_middle(const std::function<double(int, int)>& light) {
    Grid2D<RadianceNode> raw;
    raw.assign(k_smoothed_nodes, k_smoothed_nodes);
    for (int j = 0; j < raw.height(); ++j)
        for (int i = 0; i < raw.width(); ++i) {
            RadianceNode& node = raw(i, j);
            node.has_ray = true;
            node.surface = NodeSurface{1, Point3{0, 0, 0}, Vector3{0, 0, 1}, false};
            node.surface_throughput = 1;
            node.mean_light = light(i - k_middle_node, j - k_middle_node);
            for (NodeRadiance& half : node.halves) {
                half.diffuse = {static_cast<float>(node.mean_light)};
                half.diffuse_mean = node.mean_light;
                half.diffuse_variance = 0.1 * 0.1;
            }
        }
    const Grid2D<SmoothNode> smooth = smoothed_surfaces(raw, 1, 1);
    return static_cast<double>(smooth(k_middle_node, k_middle_node).light.diffuse.at(0));
}

TEST(NodeSmoothing, LeavesNoSpotWhereChanceIsAlikeInBothHalves) {
    // What no neighbour bears out is smoothed over the 200 nodes around: its weight there is 1/50.
    for (const double off : {-0.45, 0.3, 0.45}) {
        const auto light = [&](int dx, int dy) { return dx == 0 && dy == 0 ? 1 + off : 1; };
        EXPECT_NEAR(smoothed_in_the_middle(light), 1, 0.03) << off;
    }
}

TEST(NodeSmoothing, KeepsTheHaloOfALamp) {
    // As far as its noise allows: 1.5 standard deviations.
    const auto light = [](int dx, int dy) { return 1 + 5 * std::exp(-(dx * dx + dy * dy) / 8.0); };
    EXPECT_NEAR(smoothed_in_the_middle(light), 6, 0.15);
}

}  // namespace
}  // namespace uw
