#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "core/light/emitter.h"
#include "tests/support/random_direction.h"

/// The laws that every emitter obeys, so that each class is tested in one line.
namespace uw::test {

/// The ball in which the laws of an emitter are tested. That of a mirror image lies in the water.
struct Ball {
    Point3 centre;
    double radius = 3;

    Point3 point(std::mt19937& rng) const {
        std::uniform_real_distribution<double> u(0, 1);
        return centre + radius * std::cbrt(u(rng)) * random_direction(rng);
    }
};

/// Checks that the light which reaches `x` comes in a straight line from its origin, that a tube of
/// it keeps its flux, and that it is dark outside its cone.
inline void expect_straight_light(const Emitter& emitter, const Point3& x, std::mt19937& rng) {
    const Vector3 v = x - emitter.origin(x);
    const double length = glm::length(v), relative = emitter.relative_intensity(v);
    EXPECT_GE(relative, 0);
    EXPECT_LE(relative, 1 + 1e-12);
    if (!emitter.cone().widened(1e-9).has(v)) {
        EXPECT_EQ(relative, 0);
    }
    if (relative == 0) return;
    const auto onward = [&](const Point3& from, double factor) {
        const Vector3 way = from - emitter.origin(from);
        return from + (factor - 1) * length / glm::length(way) * way;
    };
    // Neighbours across the light. The finite distance leaves an error of about its square.
    const double small = 1e-4 * length;
    const Point3 beside = x + small * glm::normalize(glm::cross(v, random_direction(rng)));
    for (const double factor : {0.5, 2.0}) {
        const Point3 y = onward(x, factor);
        EXPECT_NEAR(distance(emitter.origin(y), emitter.origin(x)), 0, 1e-11);
        if (!emitter.is_soft()) {
            EXPECT_NEAR(emitter.relative_intensity(y - emitter.origin(y)), relative, 1e-9);
        }
        const double widened = distance(onward(beside, factor), y) / small;
        EXPECT_NEAR(widened * widened, emitter.spread(factor * length) / emitter.spread(length),
                    1e-6);
    }
}

/// Checks that `passage` has the path of the light to lit points of the ray, and the angle by which
/// it is scattered towards the ray's origin there.
inline void expect_passage(const Emitter& emitter, const Ray& ray, double s) {
    const LampPassage passage = emitter.passage(ray);
    const Point3 x = ray.at(s);
    const Vector3 v = x - emitter.origin(x);
    if (emitter.relative_intensity(v) == 0) return;
    const double offset = emitter.squared_offset(ray);
    const double radius = std::sqrt(glm::dot(v, v) + offset);
    EXPECT_NEAR(passage.radius(s), radius, 1e-10);
    const Vector3 across = glm::cross(v, ray.direction);
    const double psi =
        std::atan2(std::sqrt(glm::dot(across, across) + offset), -glm::dot(v, ray.direction));
    EXPECT_NEAR(std::atan(passage.half_tangent(s, radius)), 0.5 * psi, 1e-7);
    for (const double beside : {0.99 * s, 1.01 * s})
        EXPECT_LE(std::abs(passage.radius(beside) - passage.radius(s) + beside - s),
                  passage.rate() * std::abs(beside - s) + 1e-12);
}

/// Checks that the light on the ray from `begin` to `end` lies within `beam`, and that from break
/// to break it is dark or full throughout if it is so in the middle. Returns whether the ray is
/// lit.
inline bool expect_beam_and_breaks(const Emitter& emitter, const Ray& ray, const Interval& interval,
                                   std::mt19937& rng) {
    const auto relative_at = [&](double s) {
        return emitter.relative_intensity(ray.at(s) - emitter.origin(ray.at(s)));
    };
    const Interval lit = emitter.beam(ray, interval);
    EXPECT_GE(lit.begin, interval.begin);
    EXPECT_LE(lit.end, interval.end);
    std::uniform_real_distribution<double> within(interval.begin, interval.end);
    for (int n = 0; n < 10; ++n) {
        const double s = within(rng);
        // Right at the edge rounding decides.
        if (s > lit.begin - 1e-9 && s < lit.end + 1e-9) continue;
        EXPECT_EQ(relative_at(s), 0);
    }
    std::vector<double> s{-7};
    emitter.append_profile_breaks(ray, interval, s);
    EXPECT_EQ(s.front(), -7) << "it appends";
    s.front() = interval.begin;
    s.push_back(interval.end);
    std::erase_if(s, [&](double at) { return at < interval.begin || at > interval.end; });
    std::ranges::sort(s);
    for (std::size_t i = 0; i + 1 < s.size(); ++i) {
        const double length = s[i + 1] - s[i], middle = relative_at(s[i] + 0.5 * length);
        if (length < 1e-6) continue;
        for (const double part : {0.01, 0.3, 0.7, 0.99}) {
            const double relative = relative_at(s[i] + part * length);
            if (emitter.has_even_core() && middle == 1) {
                EXPECT_EQ(relative, 1);
            }
            // A cosine is negligible, but not dark, beyond its last break.
            if (!emitter.is_soft() && middle == 0) {
                EXPECT_LT(relative, 1e-9);
            }
        }
    }
    return lit.length() > 0;
}

/// Checks that the squared offset preserves the light that the point scatters on parallel rays,
/// int 1/D dA, within 3 radii of its patch, that it is 0 beyond, and 0 without a patch.
inline void expect_offset_keeps_light(const Emitter& emitter, const Point3& towards,
                                      std::mt19937& rng) {
    const Vector3 direction = random_direction(rng);
    const Vector3 across = glm::normalize(glm::cross(direction, random_direction(rng)));
    const auto offset_at = [&](double distance) {
        return emitter.squared_offset(
            {emitter.origin(towards) - 2.0 * direction + distance * across, direction});
    };
    if (!emitter.patch() || emitter.sunlight() != nullptr) {
        for (const double distance : {0.0, 0.01, 0.3}) EXPECT_EQ(offset_at(distance), 0);
        return;
    }
    const double end = 3 * emitter.patch()->radius;
    EXPECT_EQ(offset_at(1.001 * end), 0);
    constexpr int k_steps = 2000;  // of the midpoint rule, with an error of about 1e-7
    double sum = 0;
    for (int i = 0; i < k_steps; ++i) {
        const double d = end * (i + 0.5) / k_steps;
        EXPECT_GE(d * d + offset_at(d), 0);
        sum += d / std::sqrt(d * d + offset_at(d)) * end / k_steps;
    }
    // Its constant 2.1983 has five digits.
    EXPECT_NEAR(sum / end, 1, 2e-5);
}

/// Checks that the origins on the patch surround the origin: on the mean they are in its direction,
/// to a tenth of the angle that the radius subtends, and that angle is as large as it says.
inline void expect_patch_around_origin(const Emitter& emitter, const Point3& x) {
    const Vector3 middle = emitter.origin(x) - x;
    const double length = glm::length(middle), angle = emitter.patch_angle(length);
    if (!emitter.patch()) {
        EXPECT_EQ(angle, 0);
        return;
    }
    EXPECT_NEAR(angle, emitter.patch()->radius / std::sqrt(emitter.spread(length)), 1e-15);
    constexpr int k_steps = 8;
    Vector3 mean(0);
    double greatest = 0;
    for (int i = 0; i < k_steps; ++i)
        for (int j = 0; j < k_steps; ++j)
            for (int k = 0; k < k_steps; ++k) {
                const Point3 origin = emitter.origin_on_patch(
                    x, {(i + 0.5) / k_steps, (j + 0.5) / k_steps, (k + 0.5) / k_steps});
                const Vector3 direction = glm::normalize(origin - x);
                mean += direction / (1.0 * k_steps * k_steps * k_steps);
                greatest =
                    std::max(greatest, glm::length(glm::cross(direction, glm::normalize(middle))));
            }
    EXPECT_LT(glm::length(glm::cross(mean, glm::normalize(middle))), 0.1 * angle);
    EXPECT_LT(greatest, 1.2 * angle);
}

/// Checks all laws.
inline void expect_emitter_laws(const Emitter& emitter, const Ball& ball) {
    SCOPED_TRACE(emitter.profile_name());
    std::mt19937 rng(8);
    int lit_rays = 0;
    for (int n = 0; n < 1000; ++n) {
        const Point3 x = ball.point(rng), other = ball.point(rng);
        if (emitter.contains(distance(x, emitter.origin(x)))) continue;
        expect_straight_light(emitter, x, rng);
        const Interval interval{0, distance(x, other)};
        const Ray ray{x, glm::normalize(other - x)};
        expect_passage(emitter, ray, 0.7 * interval.end);
        lit_rays += expect_beam_and_breaks(emitter, ray, interval, rng) ? 1 : 0;
        // Single precision of the map.
        const std::vector<double> s{0.2 * interval.end, 0.9 * interval.end};
        std::vector<double> values{2, 3};
        emitter.focus(ray, s, values);
        EXPECT_NEAR(values[0], 2 * emitter.focus(ray.at(s[0])), 1e-5);
        EXPECT_NEAR(values[1], 3 * emitter.focus(ray.at(s[1])), 1e-5);
        if (!emitter.is_focused()) {
            EXPECT_EQ(values, (std::vector<double>{2, 3}));
        }
        if (n >= 20) continue;
        expect_offset_keeps_light(emitter, x, rng);
        if (emitter.relative_intensity(x - emitter.origin(x)) > 0)
            expect_patch_around_origin(emitter, x);
    }
    EXPECT_GT(lit_rays, 100);
    EXPECT_TRUE(emitter == emitter);
}

/// The relative intensity of an emitter with a position integrated over all directions by the
/// midpoint rule, at a distance of 1 m [sr].
inline double solid_angle_of(const Emitter& emitter, int steps) {
    double sum = 0;
    for (int i = 0; i < steps; ++i)
        for (int j = 0; j < 2 * steps; ++j) {
            const double z = 2 * (i + 0.5) / steps - 1;
            const double azimuth = std::numbers::pi * (j + 0.5) / steps;
            const double across = std::sqrt(1 - z * z);
            sum += emitter.relative_intensity(
                {across * std::cos(azimuth), z, across * std::sin(azimuth)});
        }
    return sum * 2 * std::numbers::pi / (1.0 * steps * steps);
}

}  // namespace uw::test
