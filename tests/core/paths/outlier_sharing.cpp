// ctest labels: unit
#include "core/paths/node_smoothing.h"

#include <gtest/gtest.h>

#include <random>

#include "core/light/integrator.h"
#include "core/paths/multiple_nodes.h"
#include "tests/support/test_scene.h"

namespace uw::test {
namespace {

constexpr int k_width = 24, k_height = 18;

/// Nodes of one band and group, all of which see the same plane, with even light and some noise.
class OutlierSharing : public testing::Test {
  protected:
    OutlierSharing() {
        SceneDesc desc = pinhole_scene(12, 9);
        desc.geometry = {plane_at_z(3)};
        renderer_.set_scene(std::move(desc));
        const AssembledScene& scene = renderer_.assemble();
        intervals_ = std::make_unique<DistanceIntervals>(*scene.camera, scene.lit());
        const std::size_t count = intervals_->count();
        nodes_.assign(k_width, k_height);
        std::mt19937 rng(3);
        std::uniform_real_distribution<float> noise(0.9F, 1.1F);
        for (std::size_t at = 0; at < nodes_.size(); ++at) {
            MultipleNode& node = nodes_[at];
            node.has_ray = true;
            node.reach = k_far;
            node.surface = NodeSurface{1, {0, 0, 3}, {0, 0, -1}, false};
            // Twice as much water scatters in the right half of the image.
            const bool is_right = static_cast<int>(at) % k_width >= k_width / 2;
            node.weights.assign(count, is_right ? 0.2F : 0.1F);
            node.mean_weights = node.weights;
            for (NodeLight& half : node.halves) {
                for (const float weight : node.weights) half.water.push_back(weight * noise(rng));
                half.water_mean = half.water;
                half.diffuse = {noise(rng)};
                half.diffuse_mean = static_cast<double>(half.diffuse[0]);
            }
        }
    }
    void set_water(int x, int y, std::size_t half, float value) {
        nodes_(x, y).halves[half].water[k_interval] = value;
        nodes_(x, y).halves[half].water_mean[k_interval] = value;
    }
    double water(int x, int y, std::size_t half) const {
        return static_cast<double>(nodes_(x, y).halves[half].water[k_interval]);
    }
    double sum(std::size_t half) const {
        double all = 0;
        for (const MultipleNode& node : nodes_)
            all += static_cast<double>(node.halves[half].water[k_interval]);
        return all;
    }
    void share() {
        share_surface_outliers(nodes_, 1);
        share_water_outliers(nodes_, *intervals_, 1, 1);
    }

    static constexpr std::size_t k_interval = 2;
    Renderer renderer_;
    std::unique_ptr<DistanceIntervals> intervals_;
    Grid2D<MultipleNode> nodes_;
};

TEST_F(OutlierSharing, KeepsTheSumAndLimitsTheNode) {
    set_water(8, 9, 0, 5);
    const double before = sum(0), other_half = sum(1);
    share();
    // Rounding of single precision.
    EXPECT_NEAR(sum(0), before, 1e-5 * before);
    EXPECT_NEAR(sum(1), other_half, 1e-5 * other_half);
    // 3 standard deviations of 1 +- 0.06, or 1.5 times the other half; and its part of the excess.
    EXPECT_LT(water(8, 9, 0), 0.1 * 1.65 + 5.0 / 81);
    EXPECT_GT(water(10, 11, 0), 0.1 * 0.9 + 4.5 / 100);
    EXPECT_NEAR(water(14, 9, 0), 0.2, 0.021);  // out of reach
    for (std::size_t at = 0; at < nodes_.size(); ++at)
        for (const NodeLight& half : nodes_[at].halves)
            EXPECT_NEAR(half.water_mean[k_interval], half.water[k_interval], 1e-6);
}

TEST_F(OutlierSharing, SharesInProportionToTheWeights) {
    set_water(11, 9, 0, 20);
    share();
    EXPECT_NEAR(water(13, 8, 0) / water(9, 8, 0), 2, 0.1);
}

TEST_F(OutlierSharing, LeavesWhatBothHalvesShow) {
    set_water(8, 9, 0, 5);
    set_water(8, 9, 1, 4);
    share();
    EXPECT_EQ(water(8, 9, 0), 5);
    EXPECT_EQ(water(8, 9, 1), 4);
}

TEST_F(OutlierSharing, IsAmongNodesOfOneSurface) {
    for (int y = 0; y < k_height; ++y)
        for (int x = 0; x < 8; ++x) nodes_(x, y).surface->object_id = 2;
    nodes_(8, 9).halves[1].diffuse = {50};
    nodes_(8, 9).halves[1].diffuse_mean = 50;
    share();
    EXPECT_LT(nodes_(8, 9).halves[1].diffuse_mean, 3);
    EXPECT_GT(nodes_(10, 9).halves[1].diffuse_mean, 1.5);
    EXPECT_LT(nodes_(7, 9).halves[1].diffuse_mean, 1.11);
    EXPECT_FALSE(see_same_surface(nodes_(7, 9), nodes_(8, 9)));
}

}  // namespace
}  // namespace uw::test
