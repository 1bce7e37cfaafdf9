// ctest labels: statistical
#include "render/snow/snow_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace uw {
namespace {

SnowDesc snow_of(double exponent) {
    SnowDesc desc;
    desc.number = 4000;
    desc.least = 3e-4;
    desc.greatest = 8e-3;
    desc.exponent = exponent;
    desc.reflectance = {0.5};
    desc.drift = {0.3, -0.1, 0.05};
    desc.seed = 11;
    return desc;
}

/// All particles whose positions at a time lie in a cube.
std::vector<SnowParticle> within(const SnowField& field, const Point3& min, double edge,
                                 double time) {
    std::vector<SnowParticle> found;
    const Vector3 moved = field.displacement(time);
    for (std::size_t k = 0; k < field.classes().size(); ++k) {
        const double step = field.classes()[k].edge;
        std::vector<SnowParticle> all;
        const auto cell = [&](double x) { return static_cast<std::int64_t>(std::floor(x / step)); };
        for (auto i = cell(min.x - moved.x); i <= cell(min.x + edge - moved.x); ++i)
            for (auto j = cell(min.y - moved.y); j <= cell(min.y + edge - moved.y); ++j)
                for (auto l = cell(min.z - moved.z); l <= cell(min.z + edge - moved.z); ++l)
                    field.append_particles(k, {i, j, l}, time, all);
        for (const SnowParticle& p : all) {
            const Vector3 in = p.position - min;
            if (std::min({in.x, in.y, in.z}) >= 0 && std::max({in.x, in.y, in.z}) < edge)
                found.push_back(p);
        }
    }
    return found;
}

/// Kolmogorov and Smirnov: sqrt(n) D exceeds 2.1 with a probability of 3e-4; the seed is fixed.
TEST(SnowField, DiametersFollowJungesDistribution) {
    for (const double exponent : {3.0, 4.0, 5.0}) {
        const SnowDesc desc = snow_of(exponent);
        std::vector<SnowParticle> all = within(SnowField(desc), {-3, 2, 7}, 2.7, 0);
        std::ranges::sort(all, {}, &SnowParticle::diameter);
        const double n = static_cast<double>(all.size()), power = 1 - exponent;
        ASSERT_GT(n, 70'000);
        double most = 0;
        for (std::size_t i = 0; i < all.size(); ++i) {
            const double expected =
                (std::pow(all[i].diameter, power) - std::pow(desc.least, power)) /
                (std::pow(desc.greatest, power) - std::pow(desc.least, power));
            const double at = static_cast<double>(i);
            most = std::max({most, std::abs(expected - at / n), std::abs(expected - (at + 1) / n)});
        }
        EXPECT_LT(std::sqrt(n) * most, 2.1) << exponent;
    }
}

/// In boxes that have nothing to do with cells, numbers are Poisson's: the mean and the variance
/// are number times volume. Five standard errors: of the mean sqrt(m/n), of the variance, of about
/// normal counts, m sqrt(2/n).
TEST(SnowField, NumbersArePoissonsWithTheNumberPerCubicMetre) {
    const SnowDesc desc = snow_of(4);
    const SnowField field(desc);
    constexpr double k_edge = 0.23;
    constexpr int k_boxes = 1500;
    double sum = 0, squares = 0;
    for (int i = 0; i < k_boxes; ++i) {
        const auto count = static_cast<double>(
            within(field, {-50 + 0.31 * i, 0.7 * (i % 7), -0.29 * i}, k_edge, 3).size());
        sum += count;
        squares += count * count;
    }
    const double mean = desc.number * std::pow(k_edge, 3);
    const double found = sum / k_boxes;
    EXPECT_NEAR(found, mean, 5 * std::sqrt(mean / k_boxes));
    EXPECT_NEAR(squares / k_boxes - found * found, mean, 5 * mean * std::sqrt(2.0 / k_boxes));
}

TEST(SnowField, ParticlesDriftWithoutChanging) {
    const SnowField field(snow_of(4));
    const auto before = within(field, {0, 0, 0}, 0.5, 0);
    const auto after = within(field, {0.6, -0.2, 0.1}, 0.5, 2);  // 2 s later
    ASSERT_GT(before.size(), 300U);
    ASSERT_EQ(before.size(), after.size());
    for (std::size_t i = 0; i < before.size(); ++i) {
        EXPECT_EQ(before[i].id, after[i].id);
        EXPECT_EQ(before[i].diameter, after[i].diameter);
        EXPECT_LT(glm::length(after[i].position - before[i].position - Vector3(0.6, -0.2, 0.1)),
                  1e-12);
    }
}

TEST(SnowField, SeedsGiveOtherParticles) {
    SnowDesc desc = snow_of(4);
    const auto first = within(SnowField(desc), {0, 0, 0}, 0.5, 0);
    ++desc.seed;
    const auto second = within(SnowField(desc), {0, 0, 0}, 0.5, 0);
    std::set<std::uint64_t> ids;
    for (const SnowParticle& particle : first) ids.insert(particle.id);
    EXPECT_EQ(ids.size(), first.size());
    for (const SnowParticle& particle : second) EXPECT_FALSE(ids.contains(particle.id));
}

}  // namespace
}  // namespace uw
