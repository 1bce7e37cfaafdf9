// ctest labels: unit analytic
#include "core/light/lamp_profile.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/support/random_direction.h"

namespace uw::test {
namespace {

Ray random_ray(std::mt19937& rng) {
    std::uniform_real_distribution<double> offset(-2, 2);
    return {{offset(rng), offset(rng), offset(rng)}, random_direction(rng)};
}

/// The cosine of the angle to `axis` under which `x` is seen from `apex`.
double cosine_at(const Point3& x, const Point3& apex, const Vector3& axis) {
    const Vector3 v = x - apex;
    return glm::dot(v, axis) / glm::length(v);
}

// Between two crossings the sign of what is crossed stays, at each it changes: a search along the
// ray in small steps finds no more and no fewer.
template <class Side, class Append>
void expect_all_crossings(const Ray& ray, const Side& side, const Append& append) {
    std::vector<double> s;
    append(s);
    std::sort(s.begin(), s.end());
    constexpr double k_end = 8, k_step = 1e-3;
    std::vector<double> found;
    for (int i = 0; i * k_step < k_end; ++i)
        if (side(ray.at(i * k_step)) != side(ray.at((i + 1) * k_step)))
            found.push_back((i + 0.5) * k_step);
    std::erase_if(s, [](double at) { return at > k_end; });
    // Two crossings within a step, as a ray that grazes has them, are seen by neither.
    for (std::size_t i = 0; i + 1 < s.size();) {
        if (s[i + 1] - s[i] > 2 * k_step) {
            ++i;
            continue;
        }
        const auto at = s.begin() + static_cast<std::ptrdiff_t>(i);
        s.erase(at, at + 2);
    }
    for (const double at : found)
        EXPECT_TRUE(std::ranges::any_of(s, [&](double x) { return std::abs(x - at) < 2 * k_step; }))
            << at;
    EXPECT_LE(std::max(s.size(), found.size()) - std::min(s.size(), found.size()), 2U);
}

TEST(RayCrossings, OfAConeAreWhereItsSideChanges) {
    std::mt19937 rng(2);
    for (int n = 0; n < 100; ++n) {
        const Ray ray = random_ray(rng);
        const Vector3 axis = random_direction(rng);
        const Point3 apex{0.1, -0.2, 0.3};
        for (const double cosine : {0.99, 0.5, -0.3}) {
            const auto within = [&](const Point3& x) {
                const Vector3 v = x - apex;
                return glm::dot(v, axis) >= cosine * glm::length(v);
            };
            expect_all_crossings(ray, within, [&](std::vector<double>& s) {
                append_cone_crossings(ray, apex, axis, cosine, s);
            });
        }
    }
}

TEST(RayCrossings, OfPlanesByHand) {
    const Ray ray{{-1, 0.5, 2}, {1, 0, 0}};
    std::vector<double> s;
    append_plane_crossing(ray, {0.5, 0, 0}, {1, 0, 0}, s);
    ASSERT_EQ(s.size(), 1U);
    EXPECT_NEAR(s[0], 1.5, 1e-12);
    append_plane_crossing(ray, {-3, 0, 0}, {1, 0, 0}, s);  // behind the ray
    append_plane_crossing(ray, {0, 0, 0}, {0, 1, 0}, s);   // along it
    EXPECT_EQ(s.size(), 1U);
    append_half_plane_crossing(ray, {0.5, 0, 0}, {0, 0, 1}, {1, 0, 0}, s);
    EXPECT_EQ(s.size(), 2U);
    append_half_plane_crossing(ray, {0.5, 0, 0}, {0, 0, -1}, {1, 0, 0}, s);  // the other half
    EXPECT_EQ(s.size(), 2U);
}

TEST(RayCrossings, NearestToTheAxisHasTheExtremeAngle) {
    std::mt19937 rng(4);
    const Point3 apex{0.1, -0.2, 0.3};
    int found = 0;
    for (int n = 0; n < 200; ++n) {
        const Ray ray = random_ray(rng);
        const Vector3 axis = random_direction(rng);
        const auto cosine = [&](double at) { return cosine_at(ray.at(at), apex, axis); };
        std::vector<double> s;
        append_nearest_to_axis(ray, apex, axis, s);
        if (s.empty() || s[0] > 100) continue;
        ++found;
        const double h = 1e-4;  // a second difference against a first: the slope vanishes
        EXPECT_NEAR((cosine(s[0] + h) - cosine(s[0] - h)) / (2 * h), 0, 1e-4) << n;
    }
    EXPECT_GT(found, 50);
}

TEST(RayCrossings, ApproachToTheAxisIsTheLeastAngleOnAStretch) {
    std::mt19937 rng(5);
    std::uniform_real_distribution<double> distance(0, 4);
    const Point3 apex{0.1, -0.2, 0.3};
    int within = 0;
    for (int n = 0; n < 1000; ++n) {
        const Ray ray = random_ray(rng);
        const Vector3 axis = random_direction(rng);
        const auto cosine = [&](double at) { return cosine_at(ray.at(at), apex, axis); };
        const double begin = distance(rng), length = distance(rng);
        const AxisApproach nearest = approach_to_axis(ray, {begin, begin + length}, apex, axis);
        EXPECT_GE(nearest.s, begin);
        EXPECT_LE(nearest.s, begin + length);
        EXPECT_NEAR(nearest.cosine, cosine(nearest.s), 1e-12);
        double greatest = -1;
        for (int i = 0; i <= 1000; ++i)
            greatest = std::max(greatest, cosine(begin + 1e-3 * i * length));
        // Between steps it is greater by no more than a parabola's height over one.
        EXPECT_GE(nearest.cosine, greatest);
        EXPECT_LE(nearest.cosine, greatest + 1e-3) << n;
        within += nearest.s > begin && nearest.s < begin + length;
    }
    EXPECT_GT(within, 40);
}

// A ray through the apex has one angle before it and another behind it.
TEST(RayCrossings, ApproachToTheAxisOfARayThroughTheApex) {
    const Ray ray{{0, 0, -1}, {0, 0, 1}};
    const Vector3 axis = glm::normalize(Vector3(0, 1, 2));
    for (const Interval stretch : {Interval{0, 3}, Interval{1, 3}}) {
        const AxisApproach nearest = approach_to_axis(ray, stretch, {0, 0, 0}, axis);
        EXPECT_EQ(nearest.s, 3);
        EXPECT_NEAR(nearest.cosine, axis.z, 1e-12);
    }
}

}  // namespace
}  // namespace uw::test
