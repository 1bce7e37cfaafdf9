#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "core/light/lamp_profile.h"
#include "tests/support/random_direction.h"

/// The laws that every lamp profile obeys, so that each class is tested in one line.
namespace uw::test {

/// The relative intensity at this angle from the axis, of a profile whose axis is z.
template <IsALampProfile P>
double intensity_at(const P& profile, double degrees) {
    const double angle = degrees * std::numbers::pi / 180;
    return profile.relative_intensity({0, std::sin(angle), std::cos(angle)});
}

/// The relative intensity of `profile` integrated over the sphere by the midpoint rule, in the
/// polar angle from the axis of its cone and the azimuth about it [sr].
template <IsALampProfile P>
double solid_angle_by_quadrature(const P& profile, int polar_steps, int azimuth_steps) {
    const Vector3 axis = profile.cone().axis;
    const Vector3 x = glm::normalize(
        glm::cross(axis, std::abs(axis.x) < 0.7 ? Vector3(1, 0, 0) : Vector3(0, 1, 0)));
    const Vector3 y = glm::cross(axis, x);
    const double d_polar = std::numbers::pi / polar_steps;
    const double d_azimuth = 2 * std::numbers::pi / azimuth_steps;
    double sum = 0;
    for (int i = 0; i < polar_steps; ++i) {
        const double polar = (i + 0.5) * d_polar;
        for (int k = 0; k < azimuth_steps; ++k) {
            const double azimuth = (k + 0.5) * d_azimuth;
            const Vector3 across = std::cos(azimuth) * x + std::sin(azimuth) * y;
            sum += std::sin(polar) *
                   profile.relative_intensity(std::cos(polar) * axis + std::sin(polar) * across);
        }
    }
    return sum * d_polar * d_azimuth;
}

/// Checks that the profile of a lamp at the origin is 0..1 and the same at any distance, dark
/// outside its cone, and, if its core is even, 1 from break to break along rays.
template <IsALampProfile P>
void expect_lamp_profile_laws(const P& profile) {
    SCOPED_TRACE(P::k_name);
    std::mt19937 rng(3);
    std::uniform_real_distribution<double> offset(-1, 1);
    const DirectionCone cone = profile.cone();
    for (int n = 0; n < 1000; ++n) {
        const Vector3 v = random_direction(rng);
        const double relative = profile.relative_intensity(v);
        EXPECT_GE(relative, 0);
        EXPECT_LE(relative, 1 + 1e-12);
        EXPECT_NEAR(profile.relative_intensity(7.0 * v), relative, 1e-12);
        if (!cone.widened(1e-9).has(v)) {
            EXPECT_EQ(relative, 0);
        }

        const Ray ray{{offset(rng), offset(rng), offset(rng)}, v};
        std::vector<double> s{0, 10};
        profile.append_breaks(ray, {0, 10}, {0, 0, 0}, s);
        std::sort(s.begin(), s.end());
        EXPECT_GE(s.front(), 0);
        for (std::size_t i = 0; profile.has_even_core() && i + 1 < s.size(); ++i) {
            const auto at = [&](double part) {
                return profile.relative_intensity(
                    from_origin(ray.at(s[i] + part * (s[i + 1] - s[i]))));
            };
            if (at(0.5) != 1) continue;
            for (const double part : {0.01, 0.3, 0.7, 0.99}) EXPECT_EQ(at(part), 1);
        }
    }
}

}  // namespace uw::test
