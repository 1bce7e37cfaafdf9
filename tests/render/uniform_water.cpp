// ctest labels: analytic
// Uniform water without a port against an adaptive quadrature of the single-scattering integral
// (physics section 5) that shares nothing with the program but the phase functions.
#include <gtest/gtest.h>

#include <numbers>

#include "tests/support/adaptive_quadrature.h"
#include "tests/support/test_scene.h"

namespace uw::test {
namespace {

constexpr double k_plane_z = 4;
constexpr double k_reflectance = 0.5;  // of geometry without a colour
constexpr double k_lamp_watts_per_sr = 50;
// The bound. The panels aim at 1e-4.
constexpr double k_image_tolerance = 1e-3;

struct Truth {
    double direct = 0;
    double backscatter = 0;
};

// What the pixel with ray direction `d` sees of the plane and of the water before it.
Truth quadrature(const Medium& medium, const Point3& lamp, const Vector3& d, int band) {
    const auto b = static_cast<std::size_t>(band);
    const double c = medium.uniform.attenuation(band);
    const double end = k_plane_z / d.z;
    const auto in_scatter = [&](double s) {
        const Vector3 from_lamp = at_origin_plus(s * d) - lamp;
        const double r = glm::length(from_lamp);
        const double cosine = glm::dot(from_lamp, -d) / r;
        const double psi = std::acos(glm::clamp(cosine, -1.0, 1.0));
        double beta = 0;
        for (std::size_t m = 0; m < medium.phase_functions.size(); ++m)
            beta += medium.uniform.scattering[m][b] * medium.phase_functions[m]->eval(psi);
        return k_lamp_watts_per_sr / (r * r) * beta * std::exp(-c * (r + s));
    };
    // Adaptive Simpson is told where the peak is, and started on pieces.
    const double foot = glm::clamp(glm::dot(from_origin(lamp), d), 0.0, end);
    Truth truth;
    for (const auto& [from, to] : {std::pair{0.0, foot}, std::pair{foot, end}}) {
        constexpr int k_pieces = 64;
        for (int i = 0; i < k_pieces && to > from; ++i)
            truth.backscatter +=
                AdaptiveQuadrature::integrate(in_scatter, from + (to - from) * i / k_pieces,
                                              from + (to - from) * (i + 1) / k_pieces, 1e-10);
    }
    const Point3 x = at_origin_plus(end * d);
    const Vector3 to_lamp = lamp - x;
    const double r = glm::length(to_lamp);
    const double cosine = -to_lamp.z / r;  // the plane's normal is -z
    if (cosine > 0)
        truth.direct = k_reflectance / std::numbers::pi * k_lamp_watts_per_sr * cosine / (r * r) *
                       std::exp(-c * (r + end));
    return truth;
}

struct Case {
    std::string name;
    Point3 lamp;
    bool kopelevich;
};

class UniformWater : public ::testing::TestWithParam<Case> {};

TEST_P(UniformWater, EqualsAdaptiveQuadratureAtEveryPixel) {
    SceneDesc desc = pinhole_scene(24, 18);
    desc.geometry = {plane_at_z(k_plane_z)};
    desc.lamps = {isotropic_lamp(GetParam().lamp, k_lamp_watts_per_sr)};
    if (GetParam().kopelevich) {
        desc.water.scattering.reset();
        desc.water.small_ppm = 0.05;
        desc.water.large_ppm = 0.6;
    }
    const TestScene scene(desc);
    const IntrinsicsDesc& k = desc.camera.intrinsics;
    double worst_direct = 0, worst_backscatter = 0;
    for (int y = 0; y < desc.camera.height; ++y) {
        for (int x = 0; x < desc.camera.width; ++x) {
            const PixelResult pixel = scene.pixel(x, y);
            const Vector3 d =
                glm::normalize(Vector3((x + 0.5 - k.cx) / k.fx, (y + 0.5 - k.cy) / k.fy, 1.0));
            for (int band = 0; band < 3; ++band) {
                const Truth truth =
                    quadrature(scene.assembled().water.medium, GetParam().lamp, d, band);
                const auto b = static_cast<std::size_t>(band);
                ASSERT_GT(truth.backscatter, 0);
                worst_backscatter = std::max(
                    worst_backscatter, std::abs(pixel.backscatter[b] / truth.backscatter - 1));
                if (truth.direct == 0)
                    EXPECT_EQ(pixel.direct[b], 0);
                else
                    worst_direct =
                        std::max(worst_direct, std::abs(pixel.direct[b] / truth.direct - 1));
            }
        }
    }
    RecordProperty("worst_direct", std::to_string(worst_direct));
    RecordProperty("worst_backscatter", std::to_string(worst_backscatter));
    EXPECT_LT(worst_direct, k_image_tolerance);
    EXPECT_LT(worst_backscatter, k_image_tolerance);
    std::cout << "worst relative error: direct " << worst_direct << ", backscatter "
              << worst_backscatter << "\n";
}

INSTANTIATE_TEST_SUITE_P(Lamps, UniformWater,
                         ::testing::Values(Case{"beside_hg", {1, -0.5, 0}, false},
                                           Case{"close_beside_hg", {0.1, 0, 0.05}, false},
                                           Case{"in_view_hg", {0.31, 0.22, 2}, false},
                                           Case{"behind_hg", {0.4, -0.3, -1.5}, false},
                                           Case{"beside_kopelevich", {1, -0.5, 0}, true},
                                           Case{"in_view_kopelevich", {0.31, 0.22, 2}, true},
                                           Case{"behind_kopelevich", {0.4, -0.3, -1.5}, true}),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace uw::test
