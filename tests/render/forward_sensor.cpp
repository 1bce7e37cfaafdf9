// ctest labels: analytic metamorphic
// Forward scatter together with what the port and the lens make of light.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>

#include "tests/support/forward/forward_direct_sum.h"
#include "tests/support/forward/forward_scenes.h"
#include "tests/support/image_laws.h"

namespace uw::test {
namespace {

using Output = RenderDesc::Output;

constexpr double k_forward_f_number = 2.8;
constexpr double k_forward_transmission = 0.95;
// Every value is rounded to float after its factor and some before.
constexpr double k_float_rounding = 4e-7;

SceneDesc seen_as(SceneDesc desc, Output output, double focal_length = 0.0085) {
    desc.render.output = output;
    desc.camera.lens = LensDesc{k_forward_f_number, focal_length, k_forward_transmission};
    return desc;
}

// Tangent of the angle to the axis inside the housing.
double tangent(const CameraDesc& camera, int x, int y) {
    const IntrinsicsDesc& k = camera.intrinsics;
    return std::hypot((x + 0.5 - k.cx) / k.fx, (y + 0.5 - k.cy) / k.fy);
}

// Each layer that holds radiance is `factor(x, y)` times that of `radiance`.
template <typename Factor>
void expect_scaled(const RenderedFilm& found, const RenderedFilm& radiance, Factor factor) {
    for (int y = 0; y < 24; ++y)
        for (int x = 0; x < 32; ++x)
            for (int band = 0; band < 3; ++band) {
                const auto near = [&](double value, double unscaled) {
                    const double truth = factor(x, y) * unscaled;
                    EXPECT_NEAR(value, truth, k_float_rounding * truth) << x << ' ' << y;
                };
                for (const Layer layer : {Layer::direct, Layer::forward, Layer::backscatter,
                                          Layer::backscatter_first, Layer::clean})
                    near(found.value(layer, x, y, band), radiance.value(layer, x, y, band));
                near(found.total(x, y, band), radiance.total(x, y, band));
                for (std::size_t lamp = 0; lamp < 2; ++lamp)
                    near(found.lamp(lamp, x, y, band), radiance.lamp(lamp, x, y, band));
                for (const Layer layer : {Layer::irradiance, Layer::exitance})
                    EXPECT_EQ(found.value(layer, x, y, band), radiance.value(layer, x, y, band));
            }
}

// Radiance is blurred; a pixel's factor is for whatever lands in it.
TEST(ForwardScatterOnSensor, IsThatOfRadianceTimesTheFactorOfThePixelItLandsIn) {
    SceneDesc desc = scattering(staged(), forward(1, Shape::exponential));
    desc.render.samples = 4;
    const RenderedFilm radiance(desc);
    const RenderedFilm sensor(seen_as(desc, Output::sensor_irradiance));
    expect_scaled(sensor, radiance, [&](int x, int y) {
        const double cosine_squared = 1 / (1 + std::pow(tangent(desc.camera, x, y), 2));
        const double focus = 1 - 0.0085 / radiance.value(Layer::range, x, y, 0);
        return std::numbers::pi / (4 * k_forward_f_number * k_forward_f_number) *
               k_forward_transmission * focus * focus * cosine_squared * cosine_squared;
    });
}

// Unpolarised light through two parallel surfaces, by the angles' sines (Born and Wolf 1.5.3).
double transmittance_of_glass(double tangent_in_air, double n_glass, double n_water) {
    const double in_air = std::atan(tangent_in_air);
    const double in_glass = std::asin(std::sin(in_air) / n_glass);
    const double in_water = std::asin(std::sin(in_air) / n_water);
    double s = 1, p = 1;
    for (const auto& [a, b] : {std::pair{in_air, in_glass}, {in_glass, in_water}}) {
        s *= 1 - std::pow(std::sin(a - b) / std::sin(a + b), 2);
        p *= 1 - std::pow(std::tan(a - b) / std::tan(a + b), 2);
    }
    return 0.5 * (s + p);
}

TEST(ForwardScatterBehindAPort, IsThatOfRadianceInWaterTimesTheTransmittance) {
    SceneDesc desc = scattering(staged(), forward(1));
    desc.camera.port = FlatPortDesc{};
    std::get<FlatPortDesc>(*desc.camera.port).distance = 0.02;
    std::get<FlatPortDesc>(*desc.camera.port).thickness = 0.01;
    const double n_glass = std::get<FlatPortDesc>(*desc.camera.port).n_glass,
                 n_water = std::get<FlatPortDesc>(*desc.camera.port).n_water;
    const RenderedFilm plain(desc);
    std::get<FlatPortDesc>(*desc.camera.port).fresnel = true;
    std::get<FlatPortDesc>(*desc.camera.port).radiance_in_air = true;
    expect_scaled(RenderedFilm(desc), plain, [&](int x, int y) {
        const double angle = tangent(desc.camera, x, y);
        return transmittance_of_glass(angle, n_glass, n_water) / (n_water * n_water);
    });
}

TEST(ForwardScatterOnSensor, ComponentsAddUpToTheBitAndStrengthZeroIsOff) {
    for (const Output output : {Output::sensor_irradiance, Output::paper}) {
        const SceneDesc off = seen_as(staged(), output);
        const RenderedFilm image(scattering(off, forward(1)));
        const RenderedFilm none(scattering(off, forward(0))), plain(off);
        EXPECT_EQ(std::memcmp(none.film().values().data(), plain.film().values().data(),
                              plain.film().values().size_bytes()),
                  0);
        EXPECT_GT(expect_components_add_up(image.film()), 0);
        for (int y = 0; y < 24; ++y)
            for (int x = 0; x < 32; ++x)
                for (int band = 0; band < 3; ++band)
                    EXPECT_NEAR(image.value(Layer::direct, x, y, band),
                                plain.value(Layer::direct, x, y, band),
                                k_float_rounding * plain.value(Layer::direct, x, y, band));
    }
}

// A wall behind one thin slab, as equations 14 to 18 of Sedlazeck and Koch 2011 have it, summed
// pixel by pixel: the camera's factors stand inside what (16) and (18) blur, not in (14) and (17).
class DirectSum {
  public:
    static constexpr double k_focal_length = 0.2;  // m: a distance of 0.6 m has a factor of 4/9
    static constexpr double k_slab_z = 0.6, k_slab = 0.04;  // m
    static constexpr int k_width = 16;

    using Values = std::vector<double>;  // per pixel, in the middle band

    /// `desc` without lens; its blur is off in `plain`.
    DirectSum(const SceneDesc& desc, const RenderedFilm& plain)
        : forward_(desc.water.forward_scatter), focal_(desc.camera.intrinsics.fx) {
        const Surface wall(desc, k_plane_z), slab(desc, k_slab_z);
        Values irradiance, response, scattered, weight;
        for (std::size_t i = 0; i < wall.path.size(); ++i) {
            const int x = static_cast<int>(i) % k_width, y = static_cast<int>(i) / k_width;
            irradiance.push_back(plain.value(Layer::irradiance, x, y, 1));
            response.push_back(plain.value(Layer::albedo, x, y, 1) / std::numbers::pi *
                               wall.transmittance[i] * wall.camera[i]);
            const double seen = slab.transmittance[i] * k_slab * slab.path[i] / k_slab_z;
            scattered.push_back(plain.value(Layer::backscatter, x, y, 1) / seen);
            weight.push_back(seen * slab.camera[i]);
        }
        signal = blurred(times(blurred(irradiance, wall.lamp), response), wall.path);
        backscatter = blurred(times(blurred(scattered, slab.lamp), weight), slab.path);
    }

    Values signal, backscatter;

  private:
    // What is seen and lit at one z.
    struct Surface {
        Surface(const SceneDesc& desc, double z) {
            const CameraDesc& camera_desc = desc.camera;
            for (int i = 0; i < camera_desc.width * camera_desc.height; ++i) {
                const IntrinsicsDesc& k = camera_desc.intrinsics;
                const Vector3 ray((i % k_width + 0.5 - k.cx) / k.fx,
                                  (i / k_width + 0.5 - k.cy) / k.fy, 1);
                const double r = z * glm::length(ray);
                path.push_back(r);
                lamp.push_back(distance(at_origin_plus(z * ray), desc.lamps[0].position));
                transmittance.push_back(std::exp(-attenuation(1) * r));
                camera.push_back(std::numbers::pi / (4 * k_forward_f_number) *
                                 k_forward_transmission * std::pow(glm::length(ray), -4) *
                                 std::pow((r - k_focal_length) / r, 2));
            }
        }
        Values path, lamp;             // m, to the camera and to the lamp
        Values transmittance, camera;  // on the way to the camera, and its factors
    };

    Values blurred(Values light, const Values& range) const {
        const Values added = direct_sum(forward_, attenuation(1), focal_, k_width, light, range);
        for (std::size_t i = 0; i < light.size(); ++i) light[i] += added[i];
        return light;
    }
    static Values times(Values light, const Values& by) {
        for (std::size_t i = 0; i < light.size(); ++i) light[i] *= by[i];
        return light;
    }

    ForwardScatterDesc forward_;
    double focal_;
};

class PaperForwardScatter : public ::testing::TestWithParam<Shape> {};

TEST_P(PaperForwardScatter, IsTheDirectSumOfItsEquations) {
    constexpr double k_half = DirectSum::k_slab / 2;
    SceneDesc desc =
        scattering(with_planes(uniform_scene({1, -0.5, 0}), 1, DirectSum::k_slab_z - k_half,
                               DirectSum::k_slab_z + k_half),
                   forward(1, GetParam()));
    desc.water.forward_scatter.B = 0.3;  // on the wall the kernel's s is 2.6 pixels
    SceneDesc off = desc;
    off.water.forward_scatter.K = 0;
    const RenderedFilm image(seen_as(desc, Output::paper, DirectSum::k_focal_length));
    const DirectSum truth(desc, RenderedFilm(off));
    double worst = 0;
    for (std::size_t i = 0; i < truth.signal.size(); ++i) {
        const auto value = [&](Layer layer) {
            const int at = static_cast<int>(i);
            return image.value(layer, at % DirectSum::k_width, at / DirectSum::k_width, 1);
        };
        const double signal = value(Layer::direct) + value(Layer::forward);
        const double backscatter = value(Layer::backscatter);
        worst = std::max({worst, std::abs(signal / truth.signal[i] - 1),
                          std::abs(backscatter / truth.backscatter[i] - 1)});
        EXPECT_NEAR(value(Layer::backscatter_first), backscatter, k_float_rounding * backscatter);
    }
    std::cout << "largest relative difference " << worst << '\n';
    // Neighbouring widths of the blur are mixed: 0.25 % of the light may lie elsewhere. The slab's
    // factor is a mean over it: (0.04/0.6)^2 / 24 off its middle's.
    EXPECT_LT(worst, 3e-3);
}

INSTANTIATE_TEST_SUITE_P(Shapes, PaperForwardScatter,
                         ::testing::Values(Shape::gaussian, Shape::exponential),
                         [](const auto& test) {
                             return test.param == Shape::gaussian ? "gaussian" : "exponential";
                         });

// The planes' own slabs against the volume's layers, both with the factor by distance.
TEST(PaperForwardScatterOf, AgreesBetweenPlanesAndVolume) {
    SceneDesc desc = seen_as(scattering(uniform_scene({1, -0.5, 0}), forward(1)), Output::paper);
    const RenderedFilm volume(desc), planes(with_planes(desc, 512, 0, 5));
    for (const Layer layer : {Layer::direct, Layer::forward, Layer::backscatter}) {
        const double worst = worst_difference(volume, planes, layer);
        std::cout << "largest difference " << worst << '\n';
        EXPECT_LE(worst, 3e-3);
    }
}

}  // namespace
}  // namespace uw::test
