// ctest labels: unit metamorphic
#include "core/geometry/geometry_scene.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>

#include "tests/support/geometry_descs.h"
#include "tests/support/meshes/mesh_fixtures.h"
#include "tests/support/meshes/vehicle_gltf.h"

namespace uw {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

const std::vector<double> k_bands{620, 540, 450};
const Ray k_through_sheet{{0.2, 0.2, -1}, {0, 0, 1}};  // through the triangle of `sheet`

/// A triangle across the z axis.
std::string sheet(double z) {
    const std::string at = " " + std::to_string(z) + "\n";
    return "v -1 -1" + at + "v 3 -1" + at + "v -1 3" + at + "f 1 2 3\n";
}

class Meshes : public testing::Test {
  protected:
    Meshes() {
        still_.file = folder_.write("still.obj", sheet(1));
        moving_.file = folder_.write("moving.obj", sheet(0));
        moving_.trajectory.emplace();
        place(4);
    }

    void place(double z) { moving_.world_from_object = Affine::translation({0, 0, z}); }

    std::unique_ptr<Surfaces> build(const std::vector<GeometryDesc>& geometry) {
        warnings_.clear();
        return build_surfaces(geometry, k_bands, warnings_, store_);
    }
    std::shared_ptr<const FileSurfaces> load(const GeometryDesc& desc,
                                             const IdsBefore& before = {}) {
        return store_.load(desc, before, std::nullopt, warnings_);
    }

    test::MeshFolder folder_;
    GeometryDesc still_, moving_;
    MeshStore store_;
    std::vector<std::string> warnings_;
};

TEST_F(Meshes, ThatStandStillAreReadOnce) {
    const auto first = load(still_);
    store_.keep_only({still_, moving_});
    EXPECT_EQ(load(still_), first);
    store_.keep_only({moving_});
    EXPECT_NE(load(still_), first);
}

// A time of the animation gives what a file read for it alone gives, in whatever order.
TEST_F(Meshes, OfAnAnimatedFileHaveThePlacesOfEachTime) {
    GeometryDesc desc;
    desc.file = folder_.write("vehicle.gltf", test::vehicle_gltf());
    desc.animation = TimeRange{0, 0.5};
    const auto alone = [&](double time) {
        GeometryDesc then = desc;
        then.time = time;
        return MeshStore().load(then, {}, std::nullopt, warnings_)->mesh->mesh.positions;
    };
    std::vector<float> last;
    for (const double time : {0.1, 0.3, 0.2, 0.1}) {
        desc.time = time;
        store_.keep_only({desc});
        const auto surfaces = load(desc);
        EXPECT_EQ(load(desc), surfaces);
        EXPECT_EQ(surfaces->mesh->mesh.positions, alone(time)) << time;
        EXPECT_NE(surfaces->mesh->mesh.positions, last);
        last = surfaces->mesh->mesh.positions;
    }
}

TEST_F(Meshes, OfAFileThatChangedAreReadAgain) {
    ASSERT_EQ(build({still_})->hit_distance(k_through_sheet), 2);
    // As many bytes at another time, and another file of the same time under the name.
    const fs::file_time_type written = fs::last_write_time(still_.file);
    folder_.write("still.obj", sheet(2));
    fs::last_write_time(still_.file, written + 5s);
    EXPECT_EQ(build({still_})->hit_distance(k_through_sheet), 3);
    const fs::path other = folder_.write("other.obj", sheet(3));
    fs::last_write_time(other, written + 5s);
    fs::rename(other, still_.file);
    EXPECT_EQ(build({still_})->hit_distance(k_through_sheet), 4);
}

TEST_F(Meshes, OfAFileWhoseMaterialsChangedAreReadAgain) {
    still_.file = folder_.write("painted.obj", "mtllib paint.mtl\nusemtl a\n" + sheet(1));
    const auto red = [&] {
        SurfaceHit hit;
        EXPECT_TRUE(build({still_})->closest_hit(k_through_sheet, 100, hit));
        return hit.reflectance[0];
    };
    folder_.write("paint.mtl", "newmtl a\nKd 0.2 0.2 0.2\n");
    const double before = red();
    EXPECT_EQ(red(), before);
    folder_.write("paint.mtl", "newmtl a\nKd 0.75 0.75 0.75\n");
    EXPECT_GT(red(), 2 * before);
    fs::remove(folder_.path("paint.mtl"));
    EXPECT_NE(red(), before);
    EXPECT_FALSE(warnings_.empty());
    red();
    EXPECT_FALSE(warnings_.empty()) << "is said of each scene";
}

TEST_F(Meshes, ThatMoveAreWhereTheyAre) {
    for (const double z : {4.0, 0.5, 2.0, 4.0}) {
        place(z);
        const auto surfaces = build({still_, moving_});
        EXPECT_EQ(surfaces->hit_distance(k_through_sheet), 1 + std::min(1.0, z)) << z;
        EXPECT_EQ(build({moving_})->hit_distance(k_through_sheet), 1 + z);
    }
}

TEST_F(Meshes, HaveTheIdsOfTheirPlace) {
    SurfaceHit hit;
    const auto id_among = [&](const std::vector<GeometryDesc>& geometry) {
        EXPECT_TRUE(build(geometry)->closest_hit(k_through_sheet, 100, hit));
        return hit.object_id;
    };
    const GeometryDesc far = test::sphere({0, 0, 50}, 1);
    EXPECT_EQ(id_among({still_, moving_}), 1U);
    EXPECT_EQ(id_among({far, still_, moving_}), 2U);
    EXPECT_EQ(id_among({far, moving_, still_, still_}), 3U);
    EXPECT_EQ(id_among({still_}), 1U);
}

}  // namespace
}  // namespace uw
