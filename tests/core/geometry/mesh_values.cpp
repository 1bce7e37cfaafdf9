// ctest labels: unit
#include "core/geometry/mesh_reader.h"

#include <gtest/gtest.h>

#include <limits>

namespace uw {
namespace {

constexpr float k_odd_nan = std::numeric_limits<float>::quiet_NaN();
constexpr float k_odd_infinity = std::numeric_limits<float>::infinity();

TEST(MeshValues, LeavesWhatIsInRange) {
    TriangleMesh mesh;
    mesh.uvs[0] = {0, 1, -5.5F, 1e6F};
    mesh.colors = {0, 0.5F, 1};
    mesh.alphas = {0, 1};
    mesh.tangents = {1, 0, 0, -1};
    mesh.materials[0].emission = {0, 1e6, 1};
    const TriangleMesh before = mesh;
    ClampedValues clamped;
    clamp_values(mesh, clamped);
    EXPECT_EQ(mesh.uvs, before.uvs);
    EXPECT_EQ(mesh.colors, before.colors);
    EXPECT_EQ(mesh.alphas, before.alphas);
    EXPECT_EQ(mesh.tangents, before.tangents);
    EXPECT_EQ(mesh.materials[0].emission, before.materials[0].emission);
    std::vector<std::string> warnings;
    clamped.report("a.glb", warnings);
    EXPECT_TRUE(warnings.empty());
}

TEST(MeshValues, CoordinatesOfTexturesAreFinite) {
    TriangleMesh mesh;
    mesh.uvs[0] = {0.5F, 0.5F, k_odd_nan, 0.5F, 0.5F, -k_odd_infinity, 1e8F, 0.5F};
    mesh.uvs[1] = {0, k_odd_infinity};
    ClampedValues clamped;
    clamp_values(mesh, clamped);
    EXPECT_EQ(mesh.uvs[0], (std::vector<float>{0.5F, 0.5F, 0, 0, 0, 0, 0, 0}));
    EXPECT_EQ(mesh.uvs[1], (std::vector<float>{0, 0}));
    EXPECT_EQ(clamped.uvs, 4U);
}

TEST(MeshValues, ColoursAreWithinOne) {
    TriangleMesh mesh;
    mesh.colors = {k_odd_nan, -1, 2, k_odd_infinity, -k_odd_infinity, 0.5F, 1.00005F, 0, 1};
    mesh.alphas = {0.5F, -3, k_odd_nan};
    ClampedValues clamped;
    clamp_values(mesh, clamped);
    // The last colour is off by rounding, which is no fault.
    EXPECT_EQ(mesh.colors, (std::vector<float>{0, 0, 1, 1, 0, 0.5F, 1, 0, 1}));
    EXPECT_EQ(mesh.alphas, (std::vector<float>{0.5F, 0, 0}));
    EXPECT_EQ(clamped.colors, 4U);
}

TEST(MeshValues, TangentsThatAreNoDirectionsAreNone) {
    TriangleMesh mesh;
    mesh.tangents = {1, 0, 0, 1, 0, k_odd_nan, 0, 1, 0, 1, 0, k_odd_infinity};
    ClampedValues clamped;
    clamp_values(mesh, clamped);
    EXPECT_EQ(mesh.tangents, (std::vector<float>{1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0}));
}

TEST(MeshValues, MaterialsHaveLimits) {
    TriangleMesh mesh;
    mesh.materials.resize(4);
    mesh.materials[0].emission = {1e300, 1, 0};
    mesh.materials[1].normal_scale = -1e300;
    mesh.materials[2].base_map.transform[3] = 1e300;
    ClampedValues clamped;
    clamp_values(mesh, clamped);
    EXPECT_EQ(mesh.materials[0].emission, (Rgb{k_max_emission, 1, 0}));
    EXPECT_EQ(mesh.materials[1].normal_scale, -k_max_normal_scale);
    EXPECT_EQ(mesh.materials[2].base_map.transform, TextureUse().transform);
    EXPECT_EQ(clamped.materials, 3U);
}

TEST(MeshValues, EachKindIsOneWarning) {
    std::vector<std::string> warnings;
    ClampedValues{3, 2, 1}.report("a.glb", warnings);
    ASSERT_EQ(warnings.size(), 3U);
    EXPECT_EQ(warnings[0],
              "a.glb: 3 texture coordinates are not finite or beyond 1e+07; taken as 0");
    EXPECT_EQ(warnings[1], "a.glb: 2 vertex colours are outside 0..1; clamped");
    EXPECT_EQ(warnings[2].substr(0, 44), "a.glb: 1 materials have an emission beyond 1");
}

}  // namespace
}  // namespace uw
