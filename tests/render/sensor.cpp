// ctest labels: analytic metamorphic
// What an image holds: radiance, sensor irradiance (physics section 7) or the paper's form.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>

#include "core/passes/pixel_renderer.h"
#include "tests/support/adaptive_quadrature.h"
#include "tests/support/test_scene.h"

namespace uw::test {
namespace {

using Output = RenderDesc::Output;

constexpr double k_focal_length = 0.0085;
constexpr double k_f_number = 2.8;
constexpr double k_transmission = 0.95;
constexpr double k_rounding = 1e-13;

SceneDesc plane_behind_port(Output output) {
    SceneDesc desc = pinhole_scene(12, 8);
    desc.geometry = {plane_at_z(1.5), box({0.1, -0.2, 0.6}, {0.3, 0.1, 0.9})};
    desc.lamps = {isotropic_lamp({0.6, -0.3, 0}, 50), isotropic_lamp({-0.4, 0.2, 0.1}, 20)};
    desc.camera.port = FlatPortDesc{};
    std::get<FlatPortDesc>(*desc.camera.port).distance = 0.02;
    std::get<FlatPortDesc>(*desc.camera.port).thickness = 0.01;
    desc.camera.lens = LensDesc{k_f_number, k_focal_length, k_transmission};
    desc.render.output = output;
    desc.render.samples = 4;
    return desc;
}

// A scene whose pixels are as images hold them: radiance times the pixel's factor.
class SeenScene {
  public:
    explicit SeenScene(const SceneDesc& desc) : scene_(desc) {}

    const AssembledScene& assembled() const { return scene_.assembled(); }
    PixelResult pixel(int x, int y) const { return seen(scene_.pixel(x, y)); }
    std::vector<PixelResult> image() const {
        std::vector<PixelResult> pixels = scene_.image();
        for (PixelResult& pixel : pixels) pixel = seen(std::move(pixel));
        return pixels;
    }

  private:
    static PixelResult seen(PixelResult pixel) {
        const auto scale = [&](Spectrum& radiance) {
            for (double& value : radiance) value *= pixel.pixel_factor;
        };
        scale(pixel.direct);
        scale(pixel.backscatter);
        scale(pixel.backscatter_first);
        scale(pixel.clean);
        for (Spectrum& lamp : pixel.lamps) scale(lamp);
        return pixel;
    }

    TestScene scene_;
};

bool same_bits(const Spectrum& a, const Spectrum& b) {
    return std::memcmp(&a, &b, sizeof(Spectrum)) == 0;
}

// Every layer of `found` that holds radiance is `factor` times that of `radiance`.
void expect_scaled(const PixelResult& found, const PixelResult& radiance, double factor) {
    for (std::size_t b = 0; b < 3; ++b) {
        const auto near = [&](double a, double unscaled) {
            EXPECT_NEAR(a, factor * unscaled, k_rounding * factor * unscaled);
        };
        near(found.direct[b], radiance.direct[b]);
        near(found.backscatter[b], radiance.backscatter[b]);
        near(found.backscatter_first[b], radiance.backscatter_first[b]);
        near(found.clean[b], radiance.clean[b]);
        for (std::size_t j = 0; j < found.lamps.size(); ++j)
            near(found.lamps[j][b], radiance.lamps[j][b]);
    }
}

TEST(SensorIrradiance, OneFactorForAllLightOfAPixel) {
    const SceneDesc desc = plane_behind_port(Output::sensor_irradiance);
    const SeenScene radiance(plane_behind_port(Output::radiance)), sensor(desc);
    const IntrinsicsDesc& k = desc.camera.intrinsics;
    for (int y = 0; y < desc.camera.height; ++y) {
        for (int x = 0; x < desc.camera.width; ++x) {
            const PixelResult found = sensor.pixel(x, y), before = radiance.pixel(x, y);
            // tan^2 of the angle inside the housing; cos^2 = 1 / (1 + tan^2).
            const double tangent_squared =
                std::pow((x + 0.5 - k.cx) / k.fx, 2) + std::pow((y + 0.5 - k.cy) / k.fy, 2);
            const double focus = (found.range - k_focal_length) / found.range;
            const double factor = std::numbers::pi / (4 * k_f_number * k_f_number) *
                                  k_transmission * focus * focus / std::pow(1 + tangent_squared, 2);
            ASSERT_GT(before.direct[0], 0);
            ASSERT_GT(before.backscatter[0], 0);
            expect_scaled(found, before, factor);
            EXPECT_TRUE(same_bits(found.irradiance, before.irradiance));
            EXPECT_TRUE(same_bits(found.transmittance, before.transmittance));
            EXPECT_EQ(found.alpha, before.alpha);
        }
    }
}

TEST(SensorIrradiance, WaterWithoutSurfaceIsFocusedAtInfinity) {
    SceneDesc desc = plane_behind_port(Output::sensor_irradiance);
    desc.geometry.clear();
    desc.camera.width = desc.camera.height = 1;
    desc.camera.intrinsics = {1, 1, 0.5, 0.5};  // the pixel's centre is the axis
    const PixelResult found = SeenScene(desc).pixel(0, 0);
    desc.render.output = Output::radiance;
    expect_scaled(found, SeenScene(desc).pixel(0, 0),
                  std::numbers::pi / (4 * k_f_number * k_f_number) * k_transmission);
}

TEST(Outputs, LampsAddUpAndTwiceTheLampsIsTwiceTheImage) {
    for (const Output output : {Output::radiance, Output::sensor_irradiance, Output::paper}) {
        SceneDesc desc = plane_behind_port(output);
        std::get<FlatPortDesc>(*desc.camera.port).fresnel = true;
        const SeenScene dim(desc);
        for (LampDesc& lamp : desc.lamps)
            for (double& intensity : lamp.intensity.value()) intensity *= 2;
        const SeenScene bright(desc);
        for (int x = 0; x < desc.camera.width; ++x) {
            const PixelResult one = dim.pixel(x, 3), two = bright.pixel(x, 3);
            for (std::size_t b = 0; b < 3; ++b) {
                // A power of two changes only exponents.
                EXPECT_EQ(two.direct[b], 2 * one.direct[b]);
                EXPECT_EQ(two.backscatter[b], 2 * one.backscatter[b]);
                const double total = one.direct[b] + one.backscatter[b];
                EXPECT_NEAR(one.lamps[0][b] + one.lamps[1][b], total, 1e-12 * total);
            }
        }
    }
}

TEST(Outputs, StoredComponentsAddUpToTheBit) {
    const std::vector<double> bands{620, 540, 450};
    const LayerPlan plan("all", bands, {});
    const BandColour colour(bands);
    for (const Output output : {Output::sensor_irradiance, Output::paper}) {
        const TestScene scene(plane_behind_port(output));
        std::vector<float> stored(plan.channel_names().size());
        for (int x = 0; x < 12; ++x) {
            PixelResult pixel = scene.pixel(x, 5);
            pixel.lamps.clear();
            store_pixel(pixel, plan, colour, stored);
            const auto direct = static_cast<std::size_t>(plan.first_channel(Layer::direct));
            const auto back = static_cast<std::size_t>(plan.first_channel(Layer::backscatter));
            for (std::size_t b = 0; b < 3; ++b) {
                EXPECT_EQ(stored[b], stored[direct + b] + stored[back + b]);
                EXPECT_EQ(stored[direct + b],
                          static_cast<float>(pixel.direct[b] * pixel.pixel_factor));
            }
        }
    }
}

TEST(Outputs, CleanIsDirectLightInClearWater) {
    for (const Output output : {Output::radiance, Output::sensor_irradiance, Output::paper}) {
        SceneDesc desc = plane_behind_port(output);
        desc.water.absorption = PerBand{0, 0, 0};
        desc.water.scattering->b = {0, 0, 0};
        for (const PixelResult& pixel : SeenScene(desc).image())
            EXPECT_NEAR(pixel.clean[1], pixel.direct[1], k_rounding * pixel.clean[1]);
    }
}

TEST(Fresnel, MultipliesRadianceAndNothingElse) {
    SceneDesc desc = plane_behind_port(Output::radiance);
    const SeenScene off(desc);
    std::get<FlatPortDesc>(*desc.camera.port).fresnel = true;
    const SeenScene on(desc);
    const double inner = std::pow((1.49 - 1) / (1.49 + 1), 2);
    const double outer = std::pow((1.49 - 1.334) / (1.49 + 1.334), 2);
    const PixelResult a = off.pixel(6, 4), b = on.pixel(6, 4);
    // 4 degrees off the axis: reflectance differs from that on it by the fourth power of the angle.
    EXPECT_NEAR(b.direct[0] / a.direct[0], (1 - inner) * (1 - outer), 1e-5);
    expect_scaled(b, a, b.direct[0] / a.direct[0]);
    EXPECT_TRUE(same_bits(a.irradiance, b.irradiance));
    EXPECT_TRUE(same_bits(a.transmittance, b.transmittance));
    // Half of the field of view farther out more is lost.
    EXPECT_LT(on.pixel(0, 0).direct[0] / off.pixel(0, 0).direct[0], b.direct[0] / a.direct[0]);
}

// Equations (15) and (18) in uniform water without a port: f(Z) = ((Z - F)/Z)^2 inside the
// integral.
TEST(PaperOutput, EqualsQuadratureOfItsEquations) {
    constexpr double k_plane_z = 2;
    for (const Point3& lamp : {Point3{1, -0.5, 0}, Point3{0.1, 0, 0.05}, Point3{0.31, 0.22, 1},
                               Point3{0.02, -0.03, -0.01}}) {
        SceneDesc desc = pinhole_scene(8, 6);
        desc.geometry = {plane_at_z(k_plane_z)};
        desc.lamps = {isotropic_lamp(lamp, 50)};
        const SeenScene radiance(desc);
        desc.camera.lens = LensDesc{k_f_number, k_focal_length, k_transmission};
        desc.render.output = Output::paper;
        const SeenScene scene(desc);
        const Medium& medium = scene.assembled().water.medium;
        const IntrinsicsDesc& k = desc.camera.intrinsics;
        double worst = 0;
        for (int i = 0; i < 48; ++i) {
            const int x = i % 8, y = i / 8;
            const Vector3 d =
                glm::normalize(Vector3((x + 0.5 - k.cx) / k.fx, (y + 0.5 - k.cy) / k.fy, 1.0));
            const double end = k_plane_z / d.z;
            const double camera =
                std::pow(d.z, 4) * k_transmission * std::numbers::pi / (4 * k_f_number);
            const double c = medium.uniform.attenuation(1);
            const auto slab = [&](double z) {
                const Vector3 from_lamp = at_origin_plus(z * d) - lamp;
                const double r = glm::length(from_lamp);
                const double psi = std::acos(glm::clamp(glm::dot(from_lamp, -d) / r, -1.0, 1.0));
                const double beta =
                    medium.uniform.scattering[0][1] * medium.phase_functions[0]->eval(psi);
                return std::exp(-c * (r + z)) * 50 / (r * r) * beta *
                       std::pow((z - k_focal_length) / z, 2);
            };
            double truth = 0;
            // Octaves from F on: Simpson's rule is to see the lamp and the factor.
            for (double a = k_focal_length; a < end; a *= 1.05)
                truth += AdaptiveQuadrature::integrate(slab, a, std::min(1.05 * a, end), 1e-10);
            const PixelResult pixel = scene.pixel(x, y);
            worst = std::max(worst, std::abs(pixel.backscatter[1] / (camera * truth) - 1));
            const double focus = std::pow((end - k_focal_length) / end, 2);
            const double direct = radiance.pixel(x, y).direct[1] * camera * focus;
            EXPECT_NEAR(pixel.direct[1], direct, 1e-12 * direct);
        }
        std::cout << "lamp at " << lamp.x << ": worst relative error " << worst << "\n";
        // What weighting slices by their middle promises, worst for a lamp beside the lens.
        EXPECT_LT(worst, 1e-3);
    }
}

// The planes integrator's own slabs and the slices of the weight are cut into each other.
TEST(PaperOutput, PlanesAndVolumeAgree) {
    SceneDesc desc = plane_behind_port(Output::paper);
    desc.render.samples = 1;
    const SeenScene volume(desc);
    desc.render.integrator = RenderDesc::Integrator::planes;
    desc.render.planes.count = 1024;
    const SeenScene planes(desc);
    for (int x = 0; x < desc.camera.width; ++x) {
        const double truth = volume.pixel(x, 1).backscatter[1];
        // Shadows of the box are cut off at slabs; without them planes agree to 0.1 %.
        EXPECT_NEAR(planes.pixel(x, 1).backscatter[1], truth, 3e-3 * truth) << x;
    }
}

}  // namespace
}  // namespace uw::test
