// ctest labels: analytic
#include "core/geometry/surface_reflection.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/surface_probes.h"

namespace uw {
namespace {

using std::numbers::pi;
const Vector3 k_up(0, 0, 1);

Vector3 at_angle(double theta, double phi = 0) {
    return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

TEST(Microfacet, DielectricsReflectLessUnderWater) {
    // Glass of 1.5: 4 % in air, 0.343 % against water of 1.334.
    EXPECT_NEAR(dielectric_f0(1.5), std::pow(0.166 / 2.834, 2), 1e-15);
    EXPECT_EQ(dielectric_f0(k_surface_water_index), 0);
    EXPECT_EQ(dielectric_f0(0), 1);
    // An air pocket behind thin walls reflects like air from below.
    EXPECT_NEAR(dielectric_f0(1), std::pow(0.334 / 2.334, 2), 1e-15);
}

TEST(Microfacet, TheMirrorDirectionHasTheClosedForm) {
    for (const double roughness : {0.1, 0.3, 0.5, 1.0}) {
        const double alpha = roughness * roughness;
        // On the normal D V = 1/(pi alpha^2) * 1/4.
        const MicrofacetLobe front = microfacet_lobe(k_up, k_up, k_up, roughness);
        EXPECT_NEAR(front.density * 4 * pi * alpha * alpha, 1, 1e-12);
        EXPECT_EQ(front.fresnel_weight, 0);
        for (const double theta : {0.2, 0.8, 1.3}) {
            const MicrofacetLobe lobe =
                microfacet_lobe(k_up, at_angle(theta), at_angle(theta, pi), roughness);
            // h = n; both masking terms are alike: V = 1/(4 c sqrt(c^2 + alpha^2 s^2)).
            const double c = std::cos(theta), s = std::sin(theta);
            const double expected =
                1 / (pi * alpha * alpha) / (4 * c * std::sqrt(c * c + alpha * alpha * s * s));
            EXPECT_NEAR(lobe.density / expected, 1, 1e-9) << roughness << " " << theta;
            EXPECT_NEAR(lobe.fresnel(0.04), 0.04 + 0.96 * std::pow(1 - c, 5), 1e-12);
        }
    }
}

TEST(Microfacet, IsReciprocal) {
    test::Random random;
    int compared = 0;
    for (int k = 0; k < 2000; ++k) {
        Vector3 a = random.direction(), b = random.direction();
        a.z = std::abs(a.z);
        b.z = std::abs(b.z);
        if (a.z < 1e-3 || b.z < 1e-3) continue;  // below, the view is held at the horizon
        const double roughness = random.uniform(0, 1);
        const MicrofacetLobe there = microfacet_lobe(k_up, a, b, roughness);
        const MicrofacetLobe back = microfacet_lobe(k_up, b, a, roughness);
        EXPECT_NEAR(there.density / back.density, 1, 1e-9);
        EXPECT_NEAR(there.fresnel(0.3), back.fresnel(0.3), 1e-12);
        ++compared;
    }
    EXPECT_GT(compared, 1900);
}

/// The fraction of light from `to_lamp`'s direction that a white metal reflects in all directions,
/// by the midpoint rule over half vectors: dw = 4 (v.h) dw_h.
double reflected(double theta, double roughness) {
    const Vector3 lamp = at_angle(theta);
    const double alpha = roughness * roughness;
    double sum = 0;
    constexpr int k_steps = 600, k_turns = 240;
    for (int i = 0; i < k_steps; ++i) {
        // tan(theta_h) = alpha sqrt(x / (1 - x)): equal parts of the GGX distribution.
        const double x = (i + 0.5) / k_steps;
        const double tangent = alpha * std::sqrt(x / (1 - x));
        const double theta_h = std::atan(tangent);
        const double cosine = std::cos(theta_h);
        const double spread = cosine * cosine * (alpha * alpha - 1) + 1;
        const double density = alpha * alpha * cosine / (pi * spread * spread);  // D cos
        for (int j = 0; j < k_turns; ++j) {
            const Vector3 half = at_angle(theta_h, 2 * pi * (j + 0.5) / k_turns);
            const double lh = glm::dot(lamp, half);
            if (lh <= 0) continue;
            const Vector3 out = 2 * lh * half - lamp;
            if (out.z <= 0) continue;
            const double brdf = microfacet_lobe(k_up, out, lamp, roughness).density;
            sum += brdf * out.z * 4 * lh / density;
        }
    }
    return sum / (k_steps * k_turns);
}

TEST(Microfacet, AWhiteMetalReflectsNoMoreThanItGetsAndAlmostAllIfSmooth) {
    for (const double theta : {0.05, 0.6, 1.1, 1.4}) {
        for (const double roughness : {0.05, 0.2, 0.5}) {
            const double fraction = reflected(theta, roughness);
            EXPECT_LT(fraction, 1.001) << theta << " " << roughness;  // the rule's error
            // Light reflected twice is left out.
            EXPECT_GT(fraction, roughness < 0.3 ? 0.95 : 0.75) << theta << " " << roughness;
        }
        // Fully rough, D = 1/pi and V = 1/(2 (n.l + n.v)): int mu/(mu + n.l) dmu over 0..1.
        const double nl = std::cos(theta);
        EXPECT_NEAR(reflected(theta, 1), 1 - nl * std::log1p(1 / nl), 1e-3) << theta;
    }
    EXPECT_NEAR(reflected(0.05, 0.1), 1, 1e-3);
}

TEST(Microfacet, SmootherThanTheLeastIsTheLeast) {
    const Vector3 lamp = at_angle(0.3), camera = at_angle(0.31, pi);
    EXPECT_EQ(microfacet_lobe(k_up, camera, lamp, 0).density,
              microfacet_lobe(k_up, camera, lamp, k_min_roughness).density);
    // Nothing from behind, and no NaN from anywhere.
    EXPECT_EQ(microfacet_lobe(k_up, camera, -lamp, 0.5).density, 0);
    EXPECT_EQ(microfacet_lobe(k_up, camera, -camera, 0.5).density, 0);
    EXPECT_TRUE(std::isfinite(microfacet_lobe(k_up, at_angle(1.6), lamp, 0).density));
}

}  // namespace
}  // namespace uw
