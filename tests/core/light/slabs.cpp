// ctest labels: analytic
// The slabs of the planes integrator: where they lie, and the layer of the first one.
#include "core/light/slabs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/light/planes_integrator.h"
#include "tests/support/planes_scene.h"

namespace uw::test {
namespace {

// Layer backscatter_first of the volume integrator, with the slab seen over a surface's edge.
TEST(FirstSlab, OfTheVolumeIntegratorIsThePlanesSumOverThatSlab) {
    SceneDesc desc = ported(uniform_scene({1, -0.5, 0}));
    desc.geometry.push_back(box({-0.1, -0.1, 0.6}, {0.3, 0.3, 0.7}));
    desc.render.samples = 4;
    for (const double near : {0.0, 0.4}) {
        SceneDesc volume = desc;
        volume.render.planes = {8, near, near + 4, ""};  // slabs of half a metre
        const std::vector<PixelResult> first = TestScene(volume).image();
        const std::vector<PixelResult> sum =
            TestScene(with_planes(desc, 512, near, near + 0.5)).image();
        for (std::size_t i = 0; i < first.size(); ++i) {
            for (std::size_t band = 0; band < 3; ++band) {
                // Shadow edges of the box are off by up to half a slab of 1 mm.
                EXPECT_NEAR(first[i].backscatter_first[band], sum[i].backscatter[band],
                            2e-3 * sum[i].backscatter[band]);
                EXPECT_LT(first[i].backscatter_first[band], first[i].backscatter[band]);
            }
        }
    }
}

TEST(FirstSlab, IsAsThickAsTheSceneSays) {
    SceneDesc desc = uniform_scene({1, -0.5, 0});
    desc.render.planes = {1, 0, k_plane_z + 1, ""};  // all of the water
    for (const PixelResult& pixel : TestScene(desc).image())
        EXPECT_EQ(pixel.backscatter_first, pixel.backscatter);
    desc.render.planes = {64, 3.5, 100, ""};  // reaches behind the surface
    for (const PixelResult& pixel : TestScene(desc).image()) {
        EXPECT_GT(pixel.backscatter_first[0], 0);
        EXPECT_LT(pixel.backscatter_first[0], 0.2 * pixel.backscatter[0]);
    }
}

TEST(Planes, AreRefusedWhereTheWaterIsNotUniform) {
    constexpr std::string_view k_hint =
        "the planes integrator handles only uniform water: remove `volumes` and `water.profile`, "
        "or use integrator volume";
    SceneDesc desc = with_planes(uniform_scene({1, -0.5, 0}), 8, 0, 5);
    desc.volumes.emplace_back();
    desc.volumes[0].where = "test.yaml:3:5: volumes[0]";
    try {
        const TestScene scene(desc);
        ADD_FAILURE() << "not refused";
    } catch (const InputError& error) {
        EXPECT_EQ(std::string(error.what()), "test.yaml:3:5: volumes[0]: " + std::string(k_hint));
    }
    const TestScene uniform(uniform_scene({1, -0.5, 0}));
    Medium medium = uniform.assembled().water.medium;
    medium.constituents.emplace_back();
    LitScene lit = uniform.assembled().lit();
    lit.medium = &medium;
    EXPECT_THROW(PlanesIntegrator(lit, {}, Slabs{0, 5, 8}), InputError);
}

TEST(PlaceSlabs, SpansTheWaterThatTheImageSees) {
    SceneDesc desc = uniform_scene({1, -0.5, 0});
    desc.camera.port = FlatPortDesc{{0, 0, 1}, 0.02, 0.04, 1.0, 1.49, 1.334};
    desc.geometry.push_back(box({-0.1, -0.1, 1}, {0.1, 0.1, 1.1}));
    const Slabs slabs = TestScene(desc).assembled().slabs.value();
    EXPECT_NEAR(slabs.near, 0.06, 1e-12);
    EXPECT_NEAR(slabs.thickness(), (k_plane_z - 0.06) / 64, 1e-5);  // hits are float
    // Slabs of the same thickness go on, for holes that a coarse look has not seen.
    EXPECT_GT(slabs.count, 64);
    EXPECT_NEAR(slabs.boundary(64), k_plane_z, 1e-5);
}

TEST(PlaceSlabs, ReachesAsFarAsTheLightWhereTheViewIsOpen) {
    SceneDesc desc = uniform_scene({1, -0.5, 0});
    desc.geometry.clear();
    const std::vector<PixelResult> volume = TestScene(desc).image();
    desc.render.integrator = RenderDesc::Integrator::planes;
    desc.render.planes.count = 4096;
    const TestScene planes(desc);
    EXPECT_EQ(planes.assembled().slabs->near, 0);
    EXPECT_LT(planes.assembled().slabs->far, 100);
    EXPECT_LE(difference(planes.image(), volume).worst, 1e-3);
}

/// A camera all of whose rays miss the port.
class BlindCamera : public RaySource {
  public:
    int width() const override { return 8; }
    int height() const override { return 6; }
    std::optional<Ray> refracted_ray(double, double) const override { return std::nullopt; }
    LensRay lens_ray(double, double) const override { return {}; }
    bool port_dims() const override { return false; }
    const Affine& world_from_camera() const override { return pose_; }

  private:
    Affine pose_;
};

TEST(PlaceSlabs, SpansTheReachOfTheLightForACameraThatSeesNoWater) {
    const TestScene scene(uniform_scene({1, -0.5, 0}));
    const LitScene lit = scene.assembled().lit();
    const Slabs slabs = place_slabs({64, {}, {}, ""}, BlindCamera(), lit);
    const OpticalCoefficients& water = lit.medium->uniform;
    const double least =
        std::min({water.attenuation(0), water.attenuation(1), water.attenuation(2)});
    EXPECT_EQ(slabs.near, 0);
    EXPECT_NEAR(slabs.far, std::hypot(1, 0.5) + 5 / least, 1e-9);  // e^-5 beyond the lamp
}

TEST(PlaceSlabs, RefusesSlabsWithoutWater) {
    for (const auto& [near, far] : {std::pair{4.5, 6.0}, std::pair{0.0, 0.05}}) {
        SceneDesc desc = with_planes(uniform_scene({1, -0.5, 0}), 8, near, far);
        desc.camera.port = FlatPortDesc{};
        std::get<FlatPortDesc>(*desc.camera.port).distance = 0.06;
        desc.render.planes.where = "test.yaml:9:3: render.planes";
        try {
            const TestScene scene(desc);
            ADD_FAILURE() << "not refused";
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()).find("render.planes: the slabs from z ="),
                      std::string::npos)
                << error.what();
        }
    }
}

}  // namespace
}  // namespace uw::test
