// ctest labels: unit analytic
#include "core/light/ray_panels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "core/base/numerics.h"
#include "core/light/lamp.h"

namespace uw {
namespace {

const Ray k_slanted_ray{{0.3, -1, 2}, glm::normalize(Vector3(0.5, 0.2, 1))};
const Point3 k_lamp_beside{1, 0.5, 4};

TEST(RayPanels, AnglesAndDistancesOfThePassage) {
    const LampPassage passage(k_slanted_ray, k_lamp_beside);
    for (double s = -5; s < 10; s += 0.37) {
        const Vector3 from_lamp = k_slanted_ray.at(s) - k_lamp_beside;
        const double radius = glm::length(from_lamp);
        EXPECT_NEAR(passage.radius(s), radius, 1e-14 * (1 + radius));
        // Light goes from the lamp to the point and on to the ray's origin.
        const double cosine = glm::dot(from_lamp / radius, -k_slanted_ray.direction);
        EXPECT_NEAR(passage.half_tangent(s, passage.radius(s)),
                    std::sqrt((1 - cosine) / (1 + cosine)), 1e-9)
            << s;
    }
}

TEST(RayPanels, TheFootIsNearest) {
    const LampPassage passage(k_slanted_ray, k_lamp_beside);
    EXPECT_NEAR(passage.radius(passage.foot), passage.distance, 1e-15);
    const Vector3 across = k_slanted_ray.at(passage.foot) - k_lamp_beside;
    EXPECT_NEAR(glm::dot(across, k_slanted_ray.direction), 0, 1e-14);
}

TEST(RayPanels, ThroughTheLampScatteringIsStraightOnOrBack) {
    const LampPassage passage({{0, 0, 0}, {0, 0, 1}}, {0, 0, 2});
    EXPECT_EQ(passage.distance, 0);
    EXPECT_EQ(passage.half_tangent(1, 1), 0);  // before the lamp: straight on
    EXPECT_TRUE(std::isinf(passage.half_tangent(3, 1)));
}

TEST(RayPanels, AgainstASunScatteringIsStraightOn) {
    const WaterSurfaceDesc surface{{0, 0, 0}, {0, 1, 0}};
    const Lamp overhead("sun", {{0, -1, 0}, surface}, Spectrum{});
    const LampPassage up = overhead.passage({{0, -5, 0}, {0, 1, 0}});
    EXPECT_EQ(up.half_tangent(1, up.radius(1)), 0);
    EXPECT_EQ(up.radius(1), 4);  // the light's way from the surface
    EXPECT_EQ(up.rate(), 0);     // what the ray comes nearer to it, the light has less to go
    const LampPassage across = overhead.passage({{0, -5, 0}, {1, 0, 0}});
    EXPECT_NEAR(across.half_tangent(1, across.radius(1)), 1, 1e-15);  // by a right angle
}

/// The breaks with the interval's ends, ascending.
std::vector<double> octave_panels(const LampPassage& passage, const Interval& interval) {
    std::vector<double> s{interval.begin, interval.end};
    append_octaves(passage, interval, s);
    std::ranges::sort(s);
    return s;
}

TEST(RayPanels, GaussRulesBetweenOctavesIntegrateTheInverseSquare) {
    // int ds / ((s - f)^2 + d^2) = atan((s - f) / d) / d.
    for (const double d : {2.0, 0.1, 0.002}) {
        const LampPassage passage({{0, 0, 0}, {0, 0, 1}}, {d, 0, 3});
        for (const Interval& interval : {Interval{0, 10}, {0, 2.9}, {3.5, 40}}) {
            const std::vector<double> s = octave_panels(passage, interval);
            double sum = 0;
            for (std::size_t i = 0; i + 1 < s.size(); ++i)
                for (const QuadratureNode& node : gauss_legendre(4)) {
                    const double r = passage.radius(s[i] + node.position * (s[i + 1] - s[i]));
                    sum += node.weight * (s[i + 1] - s[i]) / (r * r);
                }
            const double truth =
                (std::atan((interval.end - 3) / d) - std::atan((interval.begin - 3) / d)) / d;
            EXPECT_NEAR(sum, truth, 1e-5 * truth) << d;
        }
    }
}

TEST(RayPanels, BreaksLieInsideAndDoubleTheirDistance) {
    const LampPassage passage({{0, 0, 0}, {0, 0, 1}}, {0, 0.4, 3});
    std::vector<double> s;
    append_octaves(passage, {1, 20}, s);
    EXPECT_NE(std::ranges::find(s, 3.0), s.end());  // the foot
    std::vector<double> beyond;
    for (const double at : s) {
        EXPECT_TRUE(at > 1 && at < 20) << at;
        if (at > 3) beyond.push_back(at - 3);
    }
    ASSERT_GT(beyond.size(), 3U);
    for (std::size_t i = 0; i + 1 < beyond.size(); ++i)
        EXPECT_NEAR(beyond[i + 1], 2 * beyond[i], 1e-12);
}

TEST(RayPanels, EndAtALampOnTheRay) {
    // Without the lamp's own radius the octaves would go on for ever.
    std::vector<double> s;
    append_octaves(LampPassage({{0, 0, 0}, {0, 0, 1}}, {0, 0, 3}), {0, 10}, s);
    EXPECT_LT(s.size(), 40U);
}

}  // namespace
}  // namespace uw
