// ctest labels: analytic
// IES lamps in uniform water: the volume integrator, which breaks its panels where the profile
// does, against an adaptive quadrature of the single-scattering integral that knows nothing of
// them.
#include <gtest/gtest.h>

#include <numbers>

#include "core/light/lamp_factory.h"
#include "tests/support/ies_files.h"
#include "tests/support/scene_folder.h"
#include "tests/support/test_scene.h"

namespace uw::test {
namespace {

constexpr double k_wall_z = 4;
// The panels aim at 1e-4; the parabolas between breaks at 1e-3 of the local intensity.
constexpr double k_ies_tolerance = 1e-3;

std::filesystem::path own(const char* name) {
    return std::filesystem::path(UWVDB_SOURCE_DIR) / "assets/ies" / name;
}

/// A street light of sorts: two lobes to the sides, a sharp edge, dark behind, a dark half plane.
IesWriter asymmetric() {
    IesWriter writer;
    writer.polar = steps(0, 90, 5);
    writer.planes = steps(0, 360, 15);
    writer.candelas = [](double polar, double plane) {
        const double t = polar * std::numbers::pi / 180, a = plane * std::numbers::pi / 180;
        if (polar > 70 || (plane > 200 && plane < 290)) return 0.0;
        return 1000 * (1 + 4 * std::sin(t) * std::sin(t) * (1 + std::cos(2 * a + 0.3))) *
               (plane > 100 ? 0.6 : 1.0);
    };
    return writer;
}

double in_scatter(const AssembledScene& scene, const Ray& ray, double end) {
    const Lamp& lamp = scene.lamps[0];
    const Medium& medium = scene.water.medium;
    const double c = medium.uniform.attenuation(0);
    const auto integrand = [&](double s) {
        const Vector3 from_lamp = ray.at(s) - lamp.position();
        const double r = glm::length(from_lamp);
        const double cosine = glm::dot(from_lamp, -ray.direction) / r;
        const double psi = std::acos(glm::clamp(cosine, -1.0, 1.0));
        double beta = 0;
        for (std::size_t m = 0; m < medium.phase_functions.size(); ++m)
            beta += medium.uniform.scattering[m][0] * medium.phase_functions[m]->eval(psi);
        return lamp.axis_intensity()[0] * lamp.relative_intensity(from_lamp) / (r * r) * beta *
               std::exp(-c * (r + s));
    };
    // The kinks of the profile are no friend of any order: the midpoint rule, fine.
    constexpr int k_steps = 50000;
    double sum = 0;
    for (int i = 0; i < k_steps; ++i) sum += integrand(end * (i + 0.5) / k_steps);
    return sum * end / k_steps;
}

class IesLampWater : public testing::TestWithParam<const char*> {};

TEST_P(IesLampWater, AgreesWithQuadrature) {
    const SceneFolder folder;
    const std::string name = GetParam();
    SceneDesc desc = pinhole_scene(16, 12);
    desc.geometry = {plane_at_z(k_wall_z)};
    LampDesc lamp = isotropic_lamp({0.6, -0.3, 0.2}, 40);
    lamp.direction = glm::normalize(Vector3(-0.25, 0.1, 1));
    lamp.profile = IesProfileDesc{
        name == "asymmetric" ? folder.write("lamp.ies", asymmetric().text()) : own(name.c_str()),
        20};
    desc.lamps = {lamp};
    const TestScene scene(desc);
    double brightest = 0;
    std::vector<std::pair<double, double>> pairs;
    for (int y = 0; y < 12; y += 3) {
        for (int x = 0; x < 16; x += 3) {
            const auto ray = scene.assembled().camera->refracted_ray(x + 0.5, y + 0.5);
            const double end = k_wall_z / ray->direction.z;
            pairs.emplace_back(scene.pixel(x, y).backscatter[0],
                               in_scatter(scene.assembled(), *ray, end));
            brightest = std::max(brightest, pairs.back().second);
        }
    }
    // Relative to each pixel, and for those hardly lit to a hundredth of the brightest.
    for (const auto& [found, truth] : pairs)
        EXPECT_NEAR(found, truth, k_ies_tolerance * std::max(truth, 0.01 * brightest)) << name;
}

INSTANTIATE_TEST_SUITE_P(Files, IesLampWater,
                         testing::Values("synthetic_flood_1500lm_120deg.ies",
                                         "synthetic_flood_6000lm_70deg.ies",
                                         "synthetic_spot_6000lm_20deg.ies", "asymmetric"));

TEST(IesLampRendering, ALambertianFileIsTheCosineProfile) {
    // The file tabulates cos(theta) every 2.5 degrees: straight lines are within 2.4e-4 of it.
    const auto render = [](const LampProfileDesc& profile) {
        SceneDesc desc = pinhole_scene(8, 6);
        desc.geometry = {plane_at_z(k_wall_z)};
        desc.lamps = {isotropic_lamp({0.6, -0.3, 0}, 40)};
        desc.lamps[0].profile = profile;
        return TestScene(desc).image();
    };
    const CosineProfileDesc cosine{120};
    const IesProfileDesc file{own("synthetic_flood_1500lm_120deg.ies")};
    const std::vector<PixelResult> a = render(cosine), b = render(file);
    for (std::size_t i = 0; i < a.size(); ++i) {
        EXPECT_NEAR(a[i].direct[1], b[i].direct[1], 1e-3 * a[i].direct[1]);
        EXPECT_NEAR(a[i].backscatter[1], b[i].backscatter[1], 1e-3 * a[i].backscatter[1]);
    }
}

}  // namespace
}  // namespace uw::test
