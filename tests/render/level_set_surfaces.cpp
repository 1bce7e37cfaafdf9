// ctest labels: analytic
// Surfaces of level sets, against the sphere that they are of.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "camera/camera.h"
#include "media/volumes/level_set_mesh.h"
#include "render/scene_loading.h"
#include "tests/support/message_of.h"
#include "tests/support/temp_dir.h"
#include "tests/support/test_scene.h"
#include "tests/support/vdb/vdb_fixtures.h"

namespace uw::test {
namespace {

// A sphere of radius 1 m of voxels of 0.1 m: its points lie on it, its normals point outwards, and
// its triangles cover it.
TEST(LevelSetSurfaces, AreWhereTheDistancesVanish) {
    const TempDir dir;
    for (const bool with_class : {true, false}) {
        write_level_set(dir / "a.vdb", with_class);
        std::vector<std::string> warnings;
        const auto mesh = mesh_level_set(dir / "a.vdb", {"surface"}, "test", warnings);
        ASSERT_GT(mesh->triangle_count(), 2000U);
        ASSERT_EQ(mesh->normals.size(), mesh->positions.size());
        const auto vector = [](const std::vector<float>& of, std::size_t i) {
            return Vector3(of[3 * i], of[3 * i + 1], of[3 * i + 2]);
        };
        double area = 0;
        for (std::size_t i = 0; i < mesh->vertex_count(); ++i) {
            const Vector3 at = vector(mesh->positions, i);
            // Each is the mean of where a voxel's edges cross the sphere, below which it lies by no
            // more than the middle of the voxel's diagonal: 3 h^2 / 8 R.
            EXPECT_NEAR(glm::length(at), 1, 3.75e-3);
            EXPECT_GT(glm::dot(vector(mesh->normals, i), glm::normalize(at)), 0.999);
        }
        for (std::size_t t = 0; t < mesh->triangle_count(); ++t) {
            const Vector3 a = vector(mesh->positions, mesh->triangles[3 * t]);
            const Vector3 b = vector(mesh->positions, mesh->triangles[3 * t + 1]);
            const Vector3 c = vector(mesh->positions, mesh->triangles[3 * t + 2]);
            area += 0.5 * glm::length(glm::cross(b - a, c - a));
        }
        EXPECT_NEAR(area, 4 * std::numbers::pi, 0.01 * area);
        EXPECT_TRUE(warnings.empty());
    }
}

TEST(LevelSetSurfaces, StandAsTheirFileSays) {
    // The half space below 2 voxels along the file's z, of voxels of 0.5 m that begin at z = 3.
    const TempDir dir;
    VdbFixture slope;
    slope.name = "slope";
    slope.grid_class = "level set";
    slope.background = 3;
    slope.min = {-4, -4, -3};
    slope.max = {4, 4, 7};
    slope.value = [](int, int, int k) { return k == 2 ? 1e-6 : k - 2.0; };
    slope.file_from_index = Affine::translation({0, 0, 3}) * Affine::scale(Vector3(0.5));
    write_fixture(dir / "slope.vdb", {slope});
    for (const auto& [up, axis] : {std::pair{UpAxis::z, 1}, {UpAxis::y, 2}}) {
        std::vector<std::string> warnings;
        const auto mesh = mesh_level_set(dir / "slope.vdb", {"slope", up}, "test", warnings);
        int level = 0;
        for (std::size_t i = 0; i < mesh->vertex_count(); ++i) {
            if (std::abs(mesh->positions[3 * i + static_cast<std::size_t>(axis)] - 4) > 1e-3F)
                continue;
            ++level;
            EXPECT_GT(mesh->normals[3 * i + static_cast<std::size_t>(axis)], 0.5F);
        }
        EXPECT_GT(level, 36);
    }
}

// In an image the sphere has its depth, its number and its light.
TEST(LevelSetSurfaces, AreSeenLikeAnySurface) {
    const TempDir dir;
    write_level_set(dir / "a.vdb", true);
    const auto scene_of = [&](const std::string& geometry) {
        return ImageScene(load_scene_text(
            "uwvdb: 1\n"
            "camera: {resolution: [32, 24], intrinsics: {fov_x: 60}}\n"
            "water: {absorption: [0.1, 0.1, 0.1], scattering: {b: [0.1, 0.1, 0.1], phase: "
            "{type: hg, g: 0}}}\n"
            "lamps: [{position: [0, 0, 0], intensity: [10, 10, 10]}]\n"
            "render: {samples: 1}\n"
            "geometry: [" +
                geometry + "]\n",
            dir / "scene.yaml"));
    };
    const ImageScene mesh = scene_of(
        "{file: a.vdb, grid: surface, reflectance: 0.4, transform: {translate: [0.1, 0, 3]}}");
    const ImageScene sphere =
        scene_of("{type: sphere, center: [0.1, 0, 3], radius: 1, reflectance: 0.4}");
    const std::string layers = "range,id,direct";
    Renderer of_mesh, of_sphere;
    of_mesh.set_scene(mesh);
    of_sphere.set_scene(sphere);
    const Film image = of_mesh.render({.layers = layers}),
               truth = of_sphere.render({.layers = layers});
    const LayerPlan plan = layer_plan(mesh, layers);
    const auto at = [&](const Film& film, Layer layer, int x, int y) {
        return film.pixel(x, y)[static_cast<std::size_t>(plan.first_channel(layer))];
    };
    int seen = 0;
    for (int y = 0; y < 24; ++y)
        for (int x = 0; x < 32; ++x) {
            const Vector3 from_middle =
                Vector3(x - 16 + 0.5 - 0.1 * 27.7 / 3, y - 12 + 0.5, 0);  // fx = 27.7
            if (glm::length(from_middle) > 8.5) continue;
            ++seen;
            EXPECT_EQ(at(image, Layer::id, x, y), 1);
            EXPECT_NEAR(at(image, Layer::range, x, y), at(truth, Layer::range, x, y), 0.01);
            // 3 %: a normal that is 0.01 off, where light grazes the sphere at 22 degrees.
            EXPECT_NEAR(at(image, Layer::direct, x, y), at(truth, Layer::direct, x, y),
                        0.03F * at(truth, Layer::direct, x, y));
        }
    EXPECT_GT(seen, 200);
    EXPECT_EQ(of_mesh.assembled().surfaces->names().objects.at(0).name, "surface");
}

TEST(LevelSetSurfaces, FogHasNone) {
    const TempDir dir;
    VdbFixture fog;
    fog.max = {2, 2, 2};
    fog.value = [](int, int, int) { return 1.0; };
    write_fixture(dir / "fog.vdb", {fog});
    std::vector<std::string> warnings;
    const auto refusal = [&](const std::string& grid) {
        return message_of<InputError>(
            [&] { mesh_level_set(dir / "fog.vdb", {grid}, "test", warnings); });
    };
    EXPECT_NE(refusal("density").find("is no level set (its class is 'fog volume'"),
              std::string::npos);
    EXPECT_NE(refusal("densty").find("did you mean 'density'?"), std::string::npos);
}

}  // namespace
}  // namespace uw::test
