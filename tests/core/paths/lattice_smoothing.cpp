// ctest labels: unit statistical
#include "core/paths/lattice_smoothing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace uw {
namespace {

constexpr int k_lattice_size = 40;

/// Light of one value all over a lattice: `value(i, j)` with noise of this standard deviation in
/// the mean of both halves.
LatticeLight noisy_light(const std::function<double(int, int)>& value, double deviation) {
    LatticeLight light(k_lattice_size, k_lattice_size, 1, 1);
    std::mt19937 random(1);
    std::normal_distribution<double> noise(0, deviation * std::sqrt(2.0));
    for (std::size_t n = 0; n < light.size(); ++n) {
        const double mean =
            value(static_cast<int>(n) % k_lattice_size, static_cast<int>(n) / k_lattice_size);
        light.weights[n] = 1;
        light.brightness[n] = mean;
        light.variances[n] = static_cast<float>(deviation * deviation);
        for (const std::size_t half : {0U, 1U})
            light.of_node(half, n)[0] = static_cast<float>(mean + noise(random));
    }
    return light;
}

SmoothedLight smoothed(const LatticeLight& light) {
    return smooth(
        light, {0, 0, k_lattice_size, k_lattice_size},
        [](std::size_t, std::size_t, bool) { return true; },
        [](std::size_t, std::size_t) { return true; });
}

/// The mean squares of the errors, and of those stated, where `counts(i, j)`.
struct SquaredErrors {
    double true_ones = 0, stated = 0;
};
SquaredErrors errors_of(const SmoothedLight& light, const std::function<double(int, int)>& value,
                        const std::function<bool(int, int)>& counts) {
    SquaredErrors errors;
    double count = 0;
    for (std::size_t n = 0; n < light.is_known.size(); ++n) {
        const int i = static_cast<int>(n) % k_lattice_size,
                  j = static_cast<int>(n) / k_lattice_size;
        EXPECT_TRUE(light.is_known[n]);
        if (!counts(i, j)) continue;
        const double error = static_cast<double>(light.light[n]) - value(i, j);
        errors.true_ones += error * error;
        errors.stated += static_cast<double>(light.variances[n]);
        ++count;
    }
    return {errors.true_ones / count, errors.stated / count};
}

bool in_the_middle(int i, int j) {
    const auto is_inside = [](int k) { return k >= 8 && k < k_lattice_size - 8; };
    return is_inside(i) && is_inside(j);
}

TEST(LatticeSmoothing, TakesNoiseFromEvenLightAndStatesWhatIsLeft) {
    const auto even = [](int, int) { return 1.0; };
    const SquaredErrors errors = errors_of(smoothed(noisy_light(even, 0.1)), even, in_the_middle);
    // The widest fit alone would leave 0.03 of the variance. Where chance agrees in both halves,
    // more is left.
    EXPECT_LT(errors.true_ones, 0.12 * 0.1 * 0.1);
    // Some 30 of the nodes in the middle are independent: their mean square is known to a quarter;
    // twice that is allowed.
    EXPECT_NEAR(errors.stated / errors.true_ones, 1, 0.5);
}

TEST(LatticeSmoothing, KeepsAStepThatIsGreaterThanTheNoise) {
    const auto step = [](int i, int) { return i < k_lattice_size / 2 ? 1.0 : 2.0; };
    const auto at_the_step = [](int i, int j) {
        return in_the_middle(i, j) && std::abs(i - k_lattice_size / 2 + 0.5) < 2;
    };
    const SmoothedLight light = smoothed(noisy_light(step, 0.02));
    // No more than the noise of a node.
    EXPECT_LT(errors_of(light, step, at_the_step).true_ones, 1.5 * 0.02 * 0.02);
    // The widest fit alone would be off by up to 0.5 there.
}

TEST(LatticeSmoothing, LosesLessToSmoothingThanToNoiseAroundALamp) {
    const auto halo = [](int i, int j) {
        const double x = i - 20, y = j - 20;
        return 1 + 4 / (1 + 0.2 * (x * x + y * y));
    };
    for (const double deviation : {0.02, 0.1, 0.3}) {
        const SquaredErrors errors =
            errors_of(smoothed(noisy_light(halo, deviation)), halo, in_the_middle);
        EXPECT_LT(errors.true_ones, 0.5 * deviation * deviation) << deviation;
    }
}

TEST(LatticeSmoothing, GivesBackALonelyBrightNode) {
    const auto even = [](int, int) { return 1.0; };
    LatticeLight light = noisy_light(even, 0.1);
    const std::size_t lonely = light.size() / 2 + k_lattice_size / 2;
    // A rare bright path of one half; the light around shares it.
    light.of_node(0, lonely)[0] += 10;
    const SmoothedLight result = smoothed(light);
    EXPECT_NEAR(static_cast<double>(result.light[lonely]), 1, 0.3);
    double sum = 0;
    for (const float value : result.light) sum += static_cast<double>(value) - 1;
    // Half of what was added, and 40 x 40 nodes' noise of 0.1: twice 4.
    EXPECT_NEAR(sum, 5, 8);
}

TEST(LatticeSmoothing, KeepsTheDarkAroundANodeThatIsAllNoise) {
    const auto even = [](int, int) { return 1.0; };
    LatticeLight light = noisy_light(even, 0.1);
    const std::size_t noisy = light.size() / 2 + k_lattice_size / 2;
    light.of_node(0, noisy)[0] += 100;
    light.variances[noisy] = 50 * 50;
    const SmoothedLight result = smoothed(light);
    // The node itself has light of its own; three deviations of the others' noise are allowed. With
    // equal weights others would be too bright, and a ring beyond them too dark.
    for (std::size_t n = 0; n < light.size(); ++n)
        if (n != noisy) {
            ASSERT_NEAR(static_cast<double>(result.light[n]), 1, 0.3) << n;
        }
}

TEST(LatticeSmoothing, FillsInWhatANodeDoesNotKnow) {
    const auto plane = [](int i, int j) { return 1 + 0.02 * i + 0.01 * j; };
    LatticeLight light = noisy_light(plane, 1e-4);
    const std::size_t unknown = light.size() / 2 + k_lattice_size / 2;
    light.weights[unknown] = 0;
    light.of_node(0, unknown)[0] = light.of_node(1, unknown)[0] = 100;
    const SmoothedLight result = smoothed(light);
    EXPECT_TRUE(result.is_known[unknown]);
    EXPECT_NEAR(static_cast<double>(result.light[unknown]), plane(20, 20), 1e-3);
    // Where nothing is known far and wide, nothing is made up.
    for (double& weight : light.weights) weight = 0;
    EXPECT_FALSE(smoothed(light).is_known[unknown]);
}

}  // namespace
}  // namespace uw
