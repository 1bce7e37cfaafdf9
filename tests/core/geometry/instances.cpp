// ctest labels: unit metamorphic
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "core/geometry/geometry_scene.h"
#include "core/geometry/surfaces.h"
#include "tests/support/geometry_descs.h"
#include "tests/support/meshes/mesh_fixtures.h"
#include "tests/support/surface_probes.h"

// A mesh that several nodes of a glTF file show is kept once, and looks as its copies would.
namespace uw {
namespace {

using test::build;
using test::bytes_of;
using test::Random;

constexpr double k_beyond_nodes = 1e6;
constexpr std::size_t k_side = 7;  // squares of a sheet: 98 triangles, too many to be copied

/// Nodes with all that transforms can do: turned, mirrored, stretched, and below one another.
const std::vector<std::string> k_node_texts{
    R"({"name":"plain","mesh":0})",
    R"({"name":"turned","mesh":0,"translation":[4,0,0],"rotation":[0.2,0.4,0.1,0.8]})",
    R"({"name":"mirrored","mesh":0,"translation":[-4,0.5,0],"scale":[-1,1,1]})",
    R"({"name":"stretched","mesh":0,"translation":[0,4,-1],"scale":[0.5,2,3],"rotation":[0.5,0,0,0.8]})",
    R"({"name":"parent","translation":[0,-4,0],"scale":[1,-2,0.7],"children":[5]})",
    R"({"name":"child","mesh":0,"rotation":[0,0,0.6,0.8]})",
    R"({"name":"flat","mesh":0,"scale":[1,0,1]})"};

struct Buffer {
    std::string bytes, views, accessors;
    int count = 0;

    void add(const std::string& data, const char* type, int component, std::size_t elements) {
        const std::string comma = count == 0 ? "" : ",";
        views += comma + R"({"buffer":0,"byteOffset":)" + std::to_string(bytes.size()) +
                 R"(,"byteLength":)" + std::to_string(data.size()) + "}";
        accessors += comma + R"({"bufferView":)" + std::to_string(count++) +
                     R"(,"componentType":)" + std::to_string(component) + R"(,"count":)" +
                     std::to_string(elements) + R"(,"type":")" + type + "\"}";
        bytes += data;
    }
};

/// A wavy sheet with normals, tangents, texture coordinates and colours.
Buffer wavy_sheet() {
    std::vector<float> positions, normals, uvs, colors, tangents;
    std::vector<std::uint16_t> indices;
    const std::size_t row = k_side + 1;
    for (std::size_t k = 0; k < row * row; ++k) {
        const double u = double(k % row) / k_side, v = double(k / row) / k_side;
        const double x = 2 * u - 1, y = 2 * v - 1;
        const double z = 0.3 * std::sin(3 * x) * std::cos(2 * y);
        Vector3 n(-0.9 * std::cos(3 * x) * std::cos(2 * y), 0.6 * std::sin(3 * x) * std::sin(2 * y),
                  1);
        n /= glm::length(n);
        for (const double p : {x, y, z}) positions.push_back(float(p));
        for (int axis = 0; axis < 3; ++axis) normals.push_back(float(n[axis]));
        const Vector3 along = glm::normalize(Vector3(1, 0, 0) - n.x * n);
        for (int axis = 0; axis < 3; ++axis) tangents.push_back(float(along[axis]));
        tangents.push_back(-1);  // the map's v runs down, along y
        for (const double t : {u, v}) uvs.push_back(float(t));
        for (const double c : {u, v, 0.5, 1.0}) colors.push_back(float(c));
    }
    for (std::size_t k = 0; k < k_side * k_side; ++k) {
        const std::size_t a = k / k_side * row + k % k_side;
        for (const std::size_t corner : {a, a + 1, a + row + 1, a, a + row + 1, a + row})
            indices.push_back(static_cast<std::uint16_t>(corner));
    }
    Buffer buffer;
    buffer.add(bytes_of(positions), "VEC3", 5126, row * row);
    buffer.add(bytes_of(normals), "VEC3", 5126, row * row);
    buffer.add(bytes_of(uvs), "VEC2", 5126, row * row);
    buffer.add(bytes_of(colors), "VEC4", 5126, row * row);
    buffer.add(bytes_of(indices), "SCALAR", 5123, indices.size());
    buffer.add(bytes_of(tangents), "VEC4", 5126, row * row);
    return buffer;
}

/// Every node shows the one mesh, or each a mesh of its own with the same data.
std::string sheets_text(bool shared, const std::string& material) {
    const Buffer buffer = wavy_sheet();
    const std::string mesh =
        R"({"primitives":[{"attributes":{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2,"COLOR_0":3,"TANGENT":5},"indices":4,"material":1}]})";
    std::string nodes, meshes, roots;
    for (std::size_t k = 0; k < k_node_texts.size(); ++k) {
        std::string node = k_node_texts[k];
        const auto at = node.find(R"("mesh":0)");
        if (!shared && at != std::string::npos)
            node.replace(at, 8, R"("mesh":)" + std::to_string(k));
        const std::string comma = k == 0 ? "" : ",";
        nodes += comma + node;
        if (shared ? k == 0 : true) meshes += comma + mesh;
        if (k != 5) roots += comma + std::to_string(k);
    }
    return R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[)" + roots + R"(]}],"nodes":[)" +
           nodes + R"(],"meshes":[)" + meshes + R"(],"materials":[{"name":"unused"},)" + material +
           R"(],"textures":[{"source":0}],"images":[{"uri":"t.png"}],"accessors":[)" +
           buffer.accessors + R"(],"bufferViews":[)" + buffer.views +
           R"(],"buffers":[{"byteLength":)" + std::to_string(buffer.bytes.size()) +
           R"(,"uri":"data:application/octet-stream;base64,)" + test::base64(buffer.bytes) +
           "\"}]}";
}

class Instances : public testing::Test {
  protected:
    GeometryDesc sheets(bool shared, const std::string& material) {
        folder_.write("t.png", test::four_texel_png());
        GeometryDesc desc;
        desc.file =
            folder_.write(shared ? "shared.gltf" : "copied.gltf", sheets_text(shared, material));
        desc.world_from_object = Affine::translation({0.3, -0.2, 0.1}) *
                                 Affine::rotation_xyz_degrees({10, 20, 30}) *
                                 Affine::scale({1.1, 1.1, -1.2});
        return desc;
    }
    test::MeshFolder folder_;
};

TEST_F(Instances, LookAsCopiesOfTheMeshDo) {
    const std::string plain =
        R"({"name":"paint","pbrMetallicRoughness":{"baseColorTexture":{"index":0}}})";
    const std::string bumpy =
        R"({"name":"bumps","normalTexture":{"index":0},"emissiveFactor":[1,1,1],"emissiveTexture":{"index":0}})";
    const std::string holes =
        R"({"name":"holes","alphaMode":"MASK","alphaCutoff":0.5,"pbrMetallicRoughness":{"baseColorFactor":[1,1,1,1]}})";
    for (const std::string& material : {plain, bumpy, holes}) {
        const auto shared = build({sheets(true, material)});
        const auto copied = build({sheets(false, material)});
        EXPECT_GE(shared->triangle_count(), 5 * 2 * k_side * k_side);  // the flat one has fewer
        EXPECT_EQ(copied->triangle_count(), shared->triangle_count());
        Random random;
        int hits = 0, blocked = 0, differ = 0, bent = 0;
        std::array<int, 7> seen{};
        for (int k = 0; k < 6000; ++k) {
            const Point3 origin = random.point(7);
            const Vector3 direction = glm::normalize(random.point(4) - origin);
            SurfaceHit a, b;
            const bool found = shared->closest_hit({origin, direction}, k_beyond_nodes, a);
            const bool expected = copied->closest_hit({origin, direction}, k_beyond_nodes, b);
            const Point3 end = origin + 6.0 * direction;
            if (found != expected || (found && a.object_id != b.object_id)) {
                ++differ;  // at a silhouette, which the copies' rounded vertices move
                continue;
            }
            const bool is_blocked = shared->occluded(origin, end);
            differ += is_blocked != copied->occluded(origin, end) ? 1 : 0;
            blocked += is_blocked ? 1 : 0;
            if (!found) continue;
            ++hits;
            ++seen.at(a.object_id);
            EXPECT_EQ(a.material_id, 2U);
            EXPECT_EQ(b.material_id, 2U);
            // The copies' vertices and normals are rounded to floats at up to 8 m; grazing rays
            // see that enlarged.
            const double slope = std::abs(glm::dot(direction, b.geometric_normal));
            const double tolerance = 3e-6 / std::max(slope, 0.02);
            EXPECT_NEAR(a.distance, b.distance, 2 * tolerance);
            EXPECT_LT(glm::length(a.geometric_normal - b.geometric_normal), 2e-5);
            // Colours and bumps change by up to some ten per metre where a node shrinks the sheet.
            for (std::size_t band = 0; band < 3; ++band)
                EXPECT_NEAR(a.reflectance[band], b.reflectance[band], 30 * tolerance);
            EXPECT_LT(glm::length(a.normal - b.normal), 1e-4 + 60 * tolerance) << a.object_id;
            bent += glm::dot(a.normal, a.geometric_normal) < 0.9 ? 1 : 0;
        }
        EXPECT_GT(hits, 1000);
        EXPECT_GT(blocked, 500);
        EXPECT_LT(differ, 6);
        if (material == bumpy) {
            EXPECT_GT(bent, hits / 10);
        }
        for (const std::size_t id : {1, 2, 3, 4, 5, 6}) EXPECT_GT(seen[id], 10) << id;
    }
}

TEST_F(Instances, InTheSamePlaceAreKeptOnce) {
    std::string text = sheets_text(true, R"({"name":"paint"})");
    const std::string flat = R"({"name":"flat","mesh":0,"scale":[1,0,1]})";
    ASSERT_NE(text.find(flat), std::string::npos);
    text.replace(text.find(flat), flat.size(), R"({"name":"again","mesh":0})");
    folder_.write("t.png", test::four_texel_png());
    GeometryDesc desc;
    desc.file = folder_.write("twice.gltf", text);
    std::vector<std::string> warnings;
    const auto surfaces = build_surfaces({desc}, {620, 540, 450}, warnings);
    EXPECT_EQ(surfaces->triangle_count(), 5 * 2 * k_side * k_side);
    EXPECT_TRUE(std::ranges::any_of(warnings, [](const std::string& warning) {
        return warning.find("twice.gltf: 1 of 6 objects") != std::string::npos;
    }));
    // The one that is left out keeps its number.
    ASSERT_EQ(surfaces->names().objects.size(), 6U);
    EXPECT_EQ(surfaces->names().objects[5].name, "again");
}

TEST_F(Instances, AreNamedAndPlacedAsTheirNodes) {
    GeometryDesc desc = sheets(true, R"({"name":"paint"})");
    desc.world_from_object = Affine();
    const auto surfaces =
        build({test::sphere({0, 0, 50}, 1), desc, test::box({9, 9, 9}, {10, 10, 10})});
    const SurfaceNames& names = surfaces->names();
    std::vector<std::string> objects;
    for (const SurfaceName& object : names.objects) objects.push_back(object.name);
    EXPECT_EQ(objects, (std::vector<std::string>{"sphere", "plain", "turned", "mirrored",
                                                 "stretched", "child", "flat", "box"}));
    EXPECT_EQ(names.objects[0].entry, 0U);
    EXPECT_EQ(names.objects[6].entry, 1U);
    EXPECT_EQ(names.objects[7].entry, 2U);
    ASSERT_EQ(names.materials.size(), 2U);
    EXPECT_EQ(names.materials[0].name, "unused");
    EXPECT_EQ(names.materials[1].name, "paint");
    // Straight down on the middle of each node that keeps its mesh's middle there.
    const auto id_at = [&](double x, double y) {
        SurfaceHit hit;
        const bool found =
            surfaces->closest_hit({Point3{x, y, 20}, Vector3(0, 0, -1)}, k_beyond_nodes, hit);
        return found ? hit.object_id : 0U;
    };
    EXPECT_EQ(id_at(0.01, 0.02), 2U);
    EXPECT_EQ(id_at(4.01, 0.02), 3U);
    EXPECT_EQ(id_at(-4.01, 0.52), 4U);
    EXPECT_EQ(id_at(0.01, 4.02), 5U);
    EXPECT_EQ(id_at(0.01, -4.02), 6U);
    EXPECT_EQ(id_at(9.5, 9.5), 8U);
    EXPECT_EQ(id_at(30, 0), 0U);
}

TEST_F(Instances, PacketsEqualSingleQueriesToTheBit) {
    const auto surfaces = build({sheets(true, R"({})"), test::sphere({0, 0, 0}, 0.5)});
    Random random;
    int hits = 0;
    for (int bundle = 0; bundle < 400; ++bundle) {
        const Point3 origin = random.point(7);
        const Point3 target = random.point(4);
        std::vector<Ray> rays;
        std::vector<Point3> ends;
        for (int i = 0; i < 13; ++i) {
            const Point3 aim =
                target + std::pow(10, random.uniform(-4, 0)) * from_origin(random.point(1));
            rays.push_back({origin, glm::normalize(aim - origin)});
            ends.push_back(origin + 1.3 * (aim - origin));
        }
        std::vector<SurfaceHit> found(rays.size());
        std::vector<char> is_found(rays.size()), blocked(rays.size());
        surfaces->closest_hits(rays, k_beyond_nodes, found, is_found);
        surfaces->occluded_many(origin, ends, blocked);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            SurfaceHit one;
            EXPECT_EQ(is_found[i] != 0, surfaces->closest_hit(rays[i], k_beyond_nodes, one));
            EXPECT_EQ(found[i].distance, one.distance);
            EXPECT_EQ(found[i].normal, one.normal);
            EXPECT_EQ(found[i].object_id, one.object_id);
            EXPECT_EQ(blocked[i] != 0, surfaces->occluded(origin, ends[i]));
            hits += is_found[i];
        }
    }
    EXPECT_GT(hits, 800);
}

TEST_F(Instances, ShadowRaysDoNotHitTheSurfaceTheyEndOn) {
    const auto surfaces = build({sheets(true, R"({})")});
    Random random;
    const Point3 lamp{0.3, 1.7, 5};
    int lit = 0;
    for (int k = 0; k < 5000; ++k) {
        SurfaceHit hit;
        const Ray ray{lamp, random.direction()};
        if (!surfaces->closest_hit(ray, k_beyond_nodes, hit)) continue;
        ++lit;
        EXPECT_FALSE(surfaces->occluded(lamp, hit.position)) << k;
    }
    EXPECT_GT(lit, 200);
}

}  // namespace
}  // namespace uw
