// ctest labels: unit
#include "core/geometry/geometry_scene.h"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "core/base/error.h"
#include "tests/support/geometry_descs.h"
#include "tests/support/meshes/sheet_object.h"
#include "tests/support/message_of.h"
#include "tests/support/surface_probes.h"

namespace uw::test {
namespace {

/// Sheets as objects of a file show them, `apart` metres from one another.
SceneObjects sheets(int count, double apart) {
    SceneObjects objects{{}, {sheet_object(18, 0.3)},           {}, {}, {},
                         {}, ReflectanceBands({620, 540, 450}), {}};
    for (int i = 0; i < count; ++i) {
        const Vector3 offset = i * apart * Vector3(1, 1, 1);
        objects.instances.push_back({objects.shared_meshes[0].get(),
                                     MeshTransform(Affine::translation(offset)),
                                     static_cast<std::uint32_t>(i + 1)});
    }
    return objects;
}

TEST(TriangleOverlap, IsFoundWhereThousandsOfSheetsAre) {
    EXPECT_FALSE(find_overlap(sheets(1000, 1e-7)));
    const auto overlap = find_overlap(sheets(20000, 1e-7));
    ASSERT_TRUE(overlap);
    // A triangle of the sheet measures 1/18 m, and its cube 1/16 m, in which are those of two to
    // eight: of a few hundred that are looked at, to 20 %.
    EXPECT_GT(overlap->triangles, 0.8 * 2 * 20000);
    EXPECT_LT(overlap->triangles, 1.2 * 8 * 20000);
    EXPECT_NEAR(overlap->where.z, 0.3, 0.01);
    EXPECT_GE(overlap->object_id, 1U);
    EXPECT_LE(overlap->object_id, 20000U);
}

TEST(TriangleOverlap, IsFoundBesideMuchElse) {
    SceneObjects objects = sheets(20000, 1e-7);
    for (int i = 0; i < 10; ++i) objects.meshes.push_back(sheet_object(300, 0.3));
    EXPECT_TRUE(find_overlap(objects));
}

TEST(TriangleOverlap, IsNotWhereManyTrianglesAreBesideOneAnother) {
    EXPECT_FALSE(find_overlap(sheets(20000, 0.01)));
    SceneObjects lawn = sheets(1, 0);
    const auto blades = std::make_shared<MeshObject>();
    Random random;
    constexpr std::uint32_t k_blades = 100000;  // on a square metre
    for (std::uint32_t i = 0; i < k_blades; ++i) {
        const double x = random.uniform(0, 1), y = random.uniform(0, 1);
        for (const double value : {x, y, 0.0, x + 0.005, y, 0.0, x, y + 0.02, 0.2})
            blades->mesh.positions.push_back(static_cast<float>(value));
        for (const std::uint32_t corner : {0U, 1U, 2U})
            blades->mesh.triangles.push_back(3 * i + corner);
    }
    blades->vertex_count = 3 * k_blades;
    lawn.meshes.push_back(blades);
    EXPECT_FALSE(find_overlap(lawn));
}

TEST(TriangleOverlap, OfEntriesIsRefused) {
    std::vector<GeometryDesc> geometry;
    for (int i = 0; i < 3000; ++i) {
        geometry.push_back(box({0.1, 0.1, 0.1}, {0.9, 0.9, 0.9 + 1e-6 * i}));
        geometry.back().where = "scene.yaml:7:5: geometry";
    }
    const std::string message = message_of<InputError>([&] { build(geometry); });
    EXPECT_NE(message.find("at the object 'box', some 3.6e+04 triangles lie over one another"),
              std::string::npos)
        << message;
    EXPECT_TRUE(message.starts_with("scene.yaml:")) << message;
    geometry.resize(500);
    EXPECT_NO_THROW(build(geometry));
}

}  // namespace
}  // namespace uw::test
