// ctest labels: analytic
#include "core/geometry/surface_reflection.h"

//
// Surfaces that shine and surfaces that gleam, through the whole renderer, against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/meshes/textured_gltf.h"
#include "tests/support/test_scene.h"

namespace uw {
namespace {

using std::numbers::pi;

class SurfaceFinishes : public testing::Test {
  protected:
    /// A scene of a wall at z = 2, seen square from the origin, of one glTF material.
    SceneDesc scene(const std::string& material) {
        test::TexturedGltf gltf;
        gltf.material = material;
        SceneDesc desc = test::pinhole_scene(9, 9);
        desc.water = test::hg_water(0.8);
        desc.render.samples = 1;
        GeometryDesc wall;
        wall.file = folder_.write(std::to_string(++walls_) + ".gltf", gltf.text());
        wall.world_from_object = Affine::translation({-5, -5, 2}) * Affine::scale({10, 10, 1});
        desc.geometry = {wall};
        return desc;
    }
    test::MeshFolder folder_;
    int walls_ = 0;
};

TEST_F(SurfaceFinishes, EmissionIsSeenThroughTheWaterAndLightsNothing) {
    const auto material = [](const std::string& emission) {
        return R"({"pbrMetallicRoughness":{"baseColorFactor":[0.5,0.5,0.5,1]},"emissiveFactor":)" +
               emission + "}";
    };
    SceneDesc desc = scene(material("[0.9,0.6,0.3]"));
    desc.lamps = {test::isotropic_lamp({0.5, -0.3, 0}, 3)};
    SceneDesc dark = scene(material("[0,0,0]"));
    dark.lamps = desc.lamps;
    const test::TestScene shining(desc), plain(dark);
    const Medium& medium = shining.assembled().water.medium;
    for (const int x : {0, 4, 7}) {
        const PixelResult a = shining.pixel(x, 4), b = plain.pixel(x, 4);
        const double emission[] = {0.9, 0.6, 0.3};
        for (std::size_t band = 0; band < 3; ++band) {
            const double t = std::exp(-medium.uniform.attenuation(static_cast<int>(band)) * a.path);
            EXPECT_NEAR(a.direct[band] - b.direct[band], emission[band] * t, 1e-9);
            EXPECT_NEAR(a.clean[band] - b.clean[band], emission[band], 1e-9);
            EXPECT_EQ(a.irradiance[band], b.irradiance[band]);
            EXPECT_EQ(a.exitance[band], b.exitance[band]);
            EXPECT_EQ(a.backscatter[band], b.backscatter[band]);
        }
    }
    // Without any lamp it is seen all the same.
    desc.lamps.clear();
    EXPECT_GT(test::TestScene(desc).pixel(4, 4).direct[0], 0);
}

TEST_F(SurfaceFinishes, AMetalWallMirrorsTheLampByTheClosedForm) {
    SceneDesc desc = scene(R"({"pbrMetallicRoughness":{"baseColorFactor":[0.9,0.7,0.5,1],
        "metallicFactor":1,"roughnessFactor":0.4}})");
    desc.geometry[0].is_pbr = true;
    // At the camera's own height, so that lamp and camera see the wall's middle point at equal
    // angles: the centre's ray runs along z, the lamp stands at its origin... and a little aside.
    const Point3 lamp{0.8, 0, 0};
    desc.lamps = {test::isotropic_lamp(lamp, 7)};
    const test::TestScene wall(desc);
    const Medium& medium = wall.assembled().water.medium;
    const double alpha = 0.4 * 0.4;
    for (int x = 0; x < 9; ++x) {
        const PixelResult pixel = wall.pixel(x, 4);
        // Angles in the plane y = 0, from the wall's normal, which is -z.
        const Point3 at = pixel.hit.position;
        const double to_camera = std::atan2(-at.x, 2.0), to_lamp = std::atan2(lamp.x - at.x, 2.0);
        const double half = 0.5 * (to_camera + to_lamp), apart = 0.5 * (to_lamp - to_camera);
        const double ch = std::cos(half), nv = std::cos(to_camera), nl = std::cos(to_lamp);
        const double spread = ch * ch * (alpha * alpha - 1) + 1;
        const double d = alpha * alpha / (pi * spread * spread);
        const auto masked = [&](double c) {
            return std::sqrt(c * c * (1 - alpha * alpha) + alpha * alpha);
        };
        const double v = 0.5 / (nl * masked(nv) + nv * masked(nl));
        const double radius = 2 / nl;
        const double f0[] = {0.9, 0.7, 0.5};
        for (std::size_t band = 0; band < 3; ++band) {
            const double f = f0[band] + (1 - f0[band]) * std::pow(1 - std::cos(apart), 5);
            const double c = medium.uniform.attenuation(static_cast<int>(band));
            const double clean = 7 * nl / (radius * radius) * d * v * f;
            EXPECT_NEAR(pixel.clean[band] / clean, 1, 1e-6) << x;
            EXPECT_NEAR(pixel.direct[band] / clean, std::exp(-c * (radius + pixel.path)), 1e-6);
            EXPECT_EQ(pixel.hit.reflectance[band], 0);  // nothing of it is diffuse
            EXPECT_EQ(pixel.exitance[band], 0);
        }
    }
}

TEST_F(SurfaceFinishes, ADielectricLosesInItsDiffusePartWhatItsSurfaceReflects) {
    // Rough enough that the gleam away from the mirror direction is faint, and of an index that
    // water does not hide.
    const std::string look =
        R"({"pbrMetallicRoughness":{"baseColorFactor":[0.8,0.8,0.8,1],"metallicFactor":0,
        "roughnessFactor":0.1},"extensions":{"KHR_materials_ior":{"ior":3}}})";
    SceneDesc pbr = scene(look), diffuse = scene(look);
    pbr.geometry[0].is_pbr = true;
    pbr.lamps = diffuse.lamps = {test::isotropic_lamp({3, 0, 0}, 7)};
    const PixelResult a = test::TestScene(pbr).pixel(4, 4),
                      b = test::TestScene(diffuse).pixel(4, 4);
    const double f0 = std::pow((3 - 1.334) / (3 + 1.334), 2);
    const double vh = std::cos(0.5 * std::atan2(3.0, 2.0));
    const double fresnel = f0 + (1 - f0) * std::pow(1 - vh, 5);
    // D V F is 3e-4 there, 0.14 % of the diffuse 0.8/pi.
    EXPECT_NEAR(a.clean[1] / b.clean[1], 1 - fresnel, 3e-3);
    EXPECT_EQ(a.hit.reflectance[1], 0.8);
    EXPECT_EQ(a.irradiance[1], b.irradiance[1]);
}

}  // namespace
}  // namespace uw
