// ctest labels: analytic
// Forward scatter through the whole renderer: energies, direct sums, and what must not change
// anything.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>

#include "core/base/error.h"
#include "tests/support/forward/forward_direct_sum.h"
#include "tests/support/forward/forward_scenes.h"
#include "tests/support/image_laws.h"

namespace uw::test {
namespace {

// A small sphere that sends light to the camera from one range, and nothing else but water.
SceneDesc point_source() {
    SceneDesc desc = pinhole_scene(65, 65);
    desc.camera.intrinsics = {400, 400, 32.5, 32.5};
    GeometryDesc sphere;
    sphere.type = GeometryDesc::Type::sphere;
    sphere.center = {0, 0, 3};
    sphere.radius = 0.003;
    desc.geometry = {sphere};
    // Far behind the camera: the lamp's distance is the same all over the sphere.
    desc.lamps = {isotropic_lamp({0, 0, -2}, 100)};
    return desc;
}

TEST(ForwardScatter, OfAPointHasTheEnergyOfItsRangeInBothPlaces) {
    for (const Shape shape : {Shape::gaussian, Shape::exponential}) {
        const ForwardScatterDesc how = forward(1.2, shape);
        const RenderedFilm image(scattering(point_source(), how));
        for (int band = 0; band < 3; ++band) {
            const double c = attenuation(static_cast<std::size_t>(band));
            const auto energy = [&](double range) {
                return how.K * (std::exp(-how.G * range) - std::exp(-c * range));
            };
            const double direct = image.sum(Layer::direct, band);
            double irradiance = 0;
            int lit = 0;
            for (int y = 0; y < 65; ++y)
                for (int x = 0; x < 65; ++x)
                    if (image.value(Layer::direct, x, y, band) > 0) {
                        ++lit;
                        irradiance += image.value(Layer::irradiance, x, y, band);
                        // (14) leaves on the sphere a part of what the sphere spreads; (16) then
                        // spreads all. Measured from the layer `forward` below.
                    }
            ASSERT_GE(lit, 1);
            ASSERT_GT(irradiance, 0);
            // One pixel holds the sphere: the kernel's fraction of that pixel closes (14).
            ASSERT_EQ(lit, 1);
            const double s = 400 * how.B * 4.997 / (2 * std::numbers::pi);
            const double corner =
                shape == Shape::gaussian
                    ? std::pow(std::erf(0.5 / (2 * s)), 2) / 4
                    : std::atan2(0.25, s * std::sqrt(s * s + 0.5)) / (2 * std::numbers::pi);
            const double back = 4 * corner * energy(4.997);
            const double signal = direct * (1 + back);
            const double truth = direct * back + signal * energy(2.997);
            // The mirrored border adds to the peak what the tails lose: below 1e-3 of the tiny
            // part `back`. All else is exact.
            EXPECT_NEAR(image.sum(Layer::forward, band), truth, 1e-3 * truth);
        }
    }
}

bool same_bits(const Film& a, const Film& b) {
    return a.values().size() == b.values().size() &&
           std::memcmp(a.values().data(), b.values().data(), a.values().size_bytes()) == 0;
}

TEST(ForwardScatter, OfStrengthZeroIsOffToTheBit) {
    ForwardScatterDesc none = forward(0);
    EXPECT_TRUE(
        same_bits(RenderedFilm(scattering(staged(), none)).film(), RenderedFilm(staged()).film()));
}

TEST(ForwardScatter, IsTheSameForThreadsAndWindowsAndAddsUp) {
    for (const Shape shape : {Shape::gaussian, Shape::exponential}) {
        const SceneDesc desc = scattering(staged(), forward(1, shape));
        const Film film =
            expect_same_for_threads_and_windows(desc, {.layers = "all,lamps"}, {5, 3, 20, 17});
        EXPECT_GT(expect_components_add_up(film), 0);
    }
}

TEST(ForwardScatter, DoublesWithTheLamps) {
    SceneDesc desc = scattering(staged(), forward(1));
    const RenderedFilm once(desc);
    for (LampDesc& lamp : desc.lamps)
        for (double& value : *lamp.intensity) value *= 2;
    const RenderedFilm twice(desc);
    for (const Layer layer : {Layer::forward, Layer::backscatter, Layer::direct})
        for (int y = 0; y < 24; ++y)
            for (int x = 0; x < 32; ++x)
                EXPECT_FLOAT_EQ(static_cast<float>(twice.value(layer, x, y, 1)),
                                static_cast<float>(2 * once.value(layer, x, y, 1)));
}

class ForwardScatterOfShape : public ::testing::TestWithParam<Shape> {};

// Equations 17 and 18 for one thin slab, summed pixel by pixel.
TEST_P(ForwardScatterOfShape, OfOneSlabIsTheDirectSum) {
    const Point3 lamp(1, -0.5, 0);
    SceneDesc desc =
        scattering(with_planes(uniform_scene(lamp), 1, 1.9, 2.1), forward(1, GetParam()));
    desc.water.forward_scatter.B = 0.3;  // the kernel's s is 1.3 pixels
    const IntrinsicsDesc& k = desc.camera.intrinsics;
    const RenderedFilm image(desc);
    SceneDesc off = desc;
    off.water.forward_scatter.K = 0;
    const RenderedFilm plain(off);
    const double c = attenuation(1);
    const auto blurred = [&](const std::vector<double>& light, const std::vector<double>& range) {
        return direct_sum(desc.water.forward_scatter, c, k.fx, 16, light, range);
    };
    std::vector<double> e, weight, radius, path;
    for (int i = 0; i < 16 * 12; ++i) {
        const Vector3 ray((i % 16 + 0.5 - k.cx) / k.fx, (i / 16 + 0.5 - k.cy) / k.fy, 1);
        path.push_back(2 * glm::length(ray));
        radius.push_back(distance(at_origin_plus(2.0 * ray), lamp));
        weight.push_back(std::exp(-c * path.back()) * 0.2 * glm::length(ray));
        e.push_back(plain.value(Layer::backscatter, i % 16, i / 16, 1) / weight.back());
    }
    const std::vector<double> fallen = blurred(e, radius);
    std::vector<double> slab;
    for (std::size_t i = 0; i < e.size(); ++i) slab.push_back(weight[i] * (e[i] + fallen[i]));
    const std::vector<double> way = blurred(slab, path);
    for (int i = 0; i < 16 * 12; ++i) {
        const auto at = static_cast<std::size_t>(i);
        const double truth = slab[at] + way[at];
        // Neighbouring widths of the blur are mixed: 0.25 % of the light may lie elsewhere.
        EXPECT_NEAR(image.value(Layer::backscatter, i % 16, i / 16, 1), truth, 3e-3 * truth);
        EXPECT_NEAR(image.value(Layer::backscatter_first, i % 16, i / 16, 1), truth, 3e-3 * truth);
    }
}

// A bright box before a wall that lies in its shadow or is black: what the box spreads has the
// width of the box's own range, right across the edge.
TEST_P(ForwardScatterOfShape, KeepsTheKernelOfItsOwnSideAtADepthEdge) {
    SceneDesc desc = pinhole_scene(64, 16);
    desc.camera.intrinsics = {200, 200, 32, 8};
    desc.water.forward_scatter = forward(1, GetParam());
    GeometryDesc near = box({-1, -1, 1}, {0, 1, 1.1});
    near.reflectance = PerBand{0.8, 0.8, 0.8};
    GeometryDesc wall = plane_at_z(6);
    wall.reflectance = PerBand{0, 0, 0};
    desc.geometry = {near, wall};
    desc.lamps = {isotropic_lamp({0, 0, -1}, 50)};
    const RenderedFilm image(desc);
    // Far enough from the edge in the dark half, (14) plays no part: the wall reflects nothing.
    // The box fills columns 0..31 at ranges of 1 to 1.02 m.
    const double c = attenuation(1);
    for (int x = 33; x < 40; ++x) {
        double truth = 0;
        for (int at = -640; at < 640; ++at) {  // the image and its mirror images
            const int unfolded = ((at % 128) + 128) % 128;
            const int source = unfolded < 64 ? unfolded : 127 - unfolded;
            if (source >= 32) continue;
            const double u = (source + 0.5 - 32) / 200, range = std::sqrt(1 + u * u);
            const double s = 200 * desc.water.forward_scatter.B * range / (2 * std::numbers::pi);
            // All rows alike: the kernel integrated over y is a line's.
            const auto line = [&](double r) {
                return GetParam() == Shape::gaussian ? 0.5 * std::erf(r / (2 * s))
                                                     : std::atan(r / s) / std::numbers::pi;
            };
            const double fraction = line(x - at + 0.5) - line(x - at - 0.5);
            const double lit = image.value(Layer::direct, source, 8, 1);
            truth += lit * fraction * (std::exp(-0.05 * range) - std::exp(-c * range));
        }
        // (14) adds to the lit side what the lamp's way of 2 m brings back: at most
        // e^{-0.1} - e^{-2c}, all of which stays on the box but near the edge.
        const double most = 1 + std::exp(-0.05 * 2) - std::exp(-c * 2.1);
        const double got = image.value(Layer::forward, x, 8, 1);
        EXPECT_GT(got, 0.95 * truth) << x;
        EXPECT_LT(got, 1.05 * most * truth) << x;
    }
}

INSTANTIATE_TEST_SUITE_P(Shapes, ForwardScatterOfShape,
                         ::testing::Values(Shape::gaussian, Shape::exponential),
                         [](const auto& test) {
                             return test.param == Shape::gaussian ? "gaussian" : "exponential";
                         });

TEST(ForwardScatter, RefusesWhatHasNoMeaning) {
    SceneDesc desc = scattering(staged(), forward(1));
    desc.water.forward_scatter.G = 3;
    EXPECT_THROW(RenderedFilm{desc}, InputError);
}

}  // namespace
}  // namespace uw::test
