// ctest labels: analytic metamorphic
// Water that changes with depth: flat profiles are uniform water, two layers are integrals.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "tests/support/adaptive_quadrature.h"
#include "tests/support/film_rendering.h"
#include "tests/support/scene_folder.h"
#include "tests/support/suns.h"
#include "tests/support/test_scene.h"

namespace uw::test {
namespace {

// The world's y points down, as that of suns in tests: depths are y + 3.
SceneDesc layered_scene() {
    SceneDesc desc = pinhole_scene(12, 9);
    desc.geometry = {plane_at_z(4), box({0.1, -0.2, 1.0}, {0.4, 0.1, 1.3})};
    desc.lamps = {isotropic_lamp({1, -0.5, 0}, 50), slanting_sun()};
    desc.lamps[1].intensity = PerBand{0.2, 0.4, 0.6};
    desc.water.surface = k_sea_level;
    desc.render.quality = RenderDesc::Quality::exact;
    return desc;
}

class StratifiedWater : public testing::Test {
  protected:
    SceneDesc with_profile(SceneDesc desc, const std::string& csv) const {
        folder_.write("profile.csv", csv);
        desc.water.profile =
            DepthProfileDesc{folder_.path() / "profile.csv", "test: water.profile"};
        return desc;
    }

    SceneFolder folder_;
};

double worst_of_all(const SceneDesc& a, const SceneDesc& b) {
    const std::vector<PixelResult> p = TestScene(a).image(), q = TestScene(b).image();
    double worst = 0;
    for (std::size_t i = 0; i < p.size(); ++i)
        for (std::size_t band = 0; band < 3; ++band) {
            EXPECT_GT(q[i].backscatter[band], 0);
            EXPECT_GT(q[i].direct[band], 0);
            worst = std::max(worst, std::abs(p[i].backscatter[band] / q[i].backscatter[band] - 1));
            worst = std::max(worst, std::abs(p[i].direct[band] / q[i].direct[band] - 1));
        }
    return worst;
}

SceneDesc with_kopelevich(SceneDesc desc, double small_ppm, double large_ppm) {
    desc.water.scattering.reset();
    desc.water.small_ppm = small_ppm;
    desc.water.large_ppm = large_ppm;
    return desc;
}

TEST_F(StratifiedWater, ThatIsFlatIsUniformToTheBit) {
    SceneDesc flat = with_profile(layered_scene(), "depth_m,small,large\n0,0.05,0.4\n9,0.05,0.4\n");
    flat.water.scattering.reset();
    EXPECT_EQ(worst_of_all(flat, with_kopelevich(layered_scene(), 0.05, 0.4)), 0);
}

// Flat as far as anything is seen, with less far below: all of it comes by way of the strata.
TEST_F(StratifiedWater, ThatIsFlatWhereItIsSeenIsUniform) {
    SceneDesc desc = with_profile(
        layered_scene(),
        "depth_m,small,large\n0,0.05,0.4\n1,0.05,0.4\n2.5,0.05,0.4\n2000,0.05,0.4\n9000,0,0\n");
    desc.water.scattering.reset();
    const SceneDesc uniform = with_kopelevich(layered_scene(), 0.05, 0.4);
    EXPECT_LT(worst_of_all(desc, uniform), 1e-6);
    desc.render.integrator = RenderDesc::Integrator::reference;
    SceneDesc stepped = uniform;
    stepped.render.integrator = RenderDesc::Integrator::reference;
    EXPECT_LT(worst_of_all(desc, stepped), 3e-3);  // other steps
}

// The same for all light, by paths: their free ways are drawn in the strata.
TEST_F(StratifiedWater, HasAllLightOfUniformWaterWhereItIsFlat) {
    SceneDesc uniform = with_kopelevich(layered_scene(), 0.05, 0.4);
    uniform.water.absorption.reset();
    uniform.camera = pinhole_scene(6, 4).camera;
    uniform.render.integrator = RenderDesc::Integrator::path;
    uniform.render.samples = 2048;
    const RenderedFilm a(
        with_profile(uniform, "depth_m,absorption\n0,0.3\n2,0.3\n2000,0.3\n9000,0\n"));
    uniform.water.absorption = PerBand{0.3, 0.3, 0.3};
    const RenderedFilm b(uniform);
    for (int band = 0; band < 3; ++band) {
        double difference = 0, squares = 0, sum = 0;
        for (int y = 0; y < 4; ++y)
            for (int x = 0; x < 6; ++x) {
                difference += a.total(x, y, band) - b.total(x, y, band);
                squares += std::pow(a.value(Layer::error, x, y, band), 2) +
                           std::pow(b.value(Layer::error, x, y, band), 2);
                sum += b.total(x, y, band);
            }
        EXPECT_LT(std::abs(difference), 4 * std::sqrt(squares));
        EXPECT_LT(std::sqrt(squares), 0.01 * sum);
    }
}

// Absorption and scattering of a layer between 2.6 and 3.2 m, whose ends are ramps.
struct RampedLayer {
    double less, more;
    double operator()(double depth) const {
        if (depth <= 2.6 || depth >= 3.25) return less;
        if (depth < 2.65) return less + (more - less) * (depth - 2.6) / 0.05;
        return depth <= 3.2 ? more : more - (more - less) * (depth - 3.2) / 0.05;
    }
};

constexpr const char* k_layer =
    "depth_m,absorption,scattering\n2.6,0.1,0.05\n2.65,0.3,0.6\n3.2,0.3,0.6\n3.25,0.1,0.05\n";
constexpr RampedLayer k_layer_absorption{0.1, 0.3}, k_layer_scattering{0.05, 0.6};
constexpr double k_layer_g = 0.9, k_layered_wall = 4;

double layer_attenuation(double depth) {
    return k_layer_absorption(depth) + k_layer_scattering(depth);
}

// By quadrature over depth, from bend to bend.
double layer_depth(const Point3& a, const Point3& b) {
    const double from = a.y + 3, to = b.y + 3, length = distance(a, b);
    if (std::abs(to - from) < 1e-12) return length * layer_attenuation(from);
    std::vector<double> ends{std::min(from, to)};
    for (const double bend : {2.6, 2.65, 3.2, 3.25})
        if (bend > ends.front() && bend < std::max(from, to)) ends.push_back(bend);
    ends.push_back(std::max(from, to));
    double sum = 0;
    for (std::size_t i = 0; i + 1 < ends.size(); ++i)
        sum += AdaptiveQuadrature::integrate(layer_attenuation, ends[i], ends[i + 1], 1e-12);
    return sum * length / std::abs(to - from);
}

double layer_phase(double cosine) {
    return (1 - k_layer_g * k_layer_g) /
           (4 * std::numbers::pi *
            std::pow(1 + k_layer_g * k_layer_g - 2 * k_layer_g * cosine, 1.5));
}

TEST_F(StratifiedWater, OfLayersIsTheIntegral) {
    SceneDesc desc = pinhole_scene(12, 9);
    desc.geometry = {plane_at_z(k_layered_wall)};
    const Point3 lamp{1, -0.7, 0.2};
    desc.lamps = {isotropic_lamp(lamp, 50)};
    desc.water.surface = k_sea_level;
    desc.water.absorption.reset();
    desc.water.scattering->b = {0, 0, 0};
    desc.water.scattering->is_by_depth = true;
    desc = with_profile(desc, k_layer);
    for (const auto quality : {RenderDesc::Quality::exact, RenderDesc::Quality::final}) {
        desc.render.quality = quality;
        const TestScene scene(desc);
        double worst = 0;
        for (int y = 0; y < 9; ++y)
            for (int x = 0; x < 12; x += 5) {
                const Ray ray = *scene.assembled().camera->refracted_ray(x + 0.5, y + 0.5);
                const double end = k_layered_wall / ray.direction.z;
                std::vector<double> ends{0};
                for (const double bend : {2.6, 2.65, 3.2, 3.25}) {
                    const double s = (bend - 3) / ray.direction.y;
                    if (s > 0 && s < end) ends.push_back(s);
                }
                ends.push_back(end);
                std::ranges::sort(ends);
                double light = 0;
                for (std::size_t i = 0; i + 1 < ends.size(); ++i)
                    light += AdaptiveQuadrature::integrate(
                        [&](double s) {
                            const Point3 at = ray.at(s);
                            const Vector3 from = at - lamp;
                            const double r = glm::length(from);
                            return 50 / (r * r) * layer_phase(-glm::dot(from, ray.direction) / r) *
                                   k_layer_scattering(at.y + 3) *
                                   std::exp(-layer_depth(lamp, at) - layer_depth(at, {0, 0, 0}));
                        },
                        ends[i], ends[i + 1], 1e-9);
                const Point3 wall = ray.at(end);
                const double r = distance(lamp, wall);
                const double direct =
                    50 / std::numbers::pi * (wall.z - lamp.z) / (r * r * r) *
                    std::exp(-layer_depth(lamp, wall) - layer_depth(wall, {0, 0, 0}));
                const PixelResult pixel = scene.pixel(x, y);
                worst = std::max(worst, std::abs(pixel.backscatter[1] / light - 1));
                worst = std::max(worst, std::abs(pixel.direct[1] / (0.5 * direct) - 1));
            }
        EXPECT_LT(worst, quality == RenderDesc::Quality::exact ? 1e-5 : 1e-4);
        std::cout << "worst relative difference " << worst << "\n";
    }
}

}  // namespace
}  // namespace uw::test
