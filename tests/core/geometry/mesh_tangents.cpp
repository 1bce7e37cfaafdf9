// ctest labels: unit analytic
#include "core/geometry/mesh.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>

#include "core/image/image_file.h"

namespace uw {
namespace {

TextureUse grey_texture() {
    TextureUse use;
    use.texture = std::make_shared<const Texture>(PixelImage{1, 1, 1, {0.5F}});
    return use;
}

/// A mesh with a normal map whose texture coordinates are u = p . a and v = p . b.
TriangleMesh mapped_mesh(const std::vector<Vector3>& points, const Vector3& a, const Vector3& b,
                         const Vector3& normal) {
    TriangleMesh mesh;
    for (const Vector3& p : points) {
        for (int axis = 0; axis < 3; ++axis) {
            mesh.positions.push_back(static_cast<float>(p[axis]));
            mesh.normals.push_back(static_cast<float>(normal[axis]));
        }
        mesh.uvs[0].push_back(static_cast<float>(glm::dot(p, a)));
        mesh.uvs[0].push_back(static_cast<float>(glm::dot(p, b)));
    }
    mesh.tangents.resize(4 * points.size());
    mesh.materials[0].normal_map = grey_texture();
    return mesh;
}

const std::vector<Vector3> k_quarter{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};

void expect_tangent(const TriangleMesh& mesh, std::size_t vertex, const Vector3& direction,
                    float side) {
    for (int axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(mesh.tangents[4 * vertex + static_cast<std::size_t>(axis)], direction[axis],
                    1e-6)
            << "vertex " << vertex;
    EXPECT_EQ(mesh.tangents[4 * vertex + 3], side) << "vertex " << vertex;
}

TEST(MeshTangents, UvAxesAreTheGradientsOfTheCoordinates) {
    // Along the axes' directions only one coordinate changes: by +1 u, and by -1 v per length.
    const Vector3 a(0.5, 2, 0), b(-1, 0.25, 0);
    const TriangleMesh mesh = mapped_mesh({{0.2, 0, 0}, {1, 0.1, 0}, {0.3, 2, 0}}, a, b, {0, 0, 1});
    const std::array<std::uint32_t, 3> corners{0, 1, 2};
    UvAxes axes;
    ASSERT_TRUE(uv_axes(mesh, corners.data(), grey_texture(), axes));
    EXPECT_NEAR(glm::dot(axes.u_axis, a), 1, 1e-5);
    EXPECT_NEAR(glm::dot(axes.u_axis, b), 0, 1e-5);
    EXPECT_NEAR(glm::dot(axes.up_axis, a), 0, 1e-5);
    EXPECT_NEAR(glm::dot(axes.up_axis, b), -1, 1e-5);
}

TEST(MeshTangents, UvAxesFollowTheTexturesTransform) {
    const TriangleMesh mesh = mapped_mesh(k_quarter, {1, 0, 0}, {0, 1, 0}, {0, 0, 1});
    const std::array<std::uint32_t, 3> corners{0, 1, 2};
    TextureUse turned = grey_texture();
    turned.transform = {0, 2, 5, -2, 0, 1};  // u' = 2 v + 5, v' = -2 u + 1
    UvAxes axes;
    ASSERT_TRUE(uv_axes(mesh, corners.data(), turned, axes));
    EXPECT_EQ(axes.u_axis, Vector3(0, 0.5, 0));
    EXPECT_EQ(axes.up_axis, Vector3(0.5, 0, 0));
}

TEST(MeshTangents, DegenerateCoordinatesHaveNoAxes) {
    const std::array<std::uint32_t, 3> corners{0, 1, 2};
    UvAxes axes;
    for (const Vector3& a : {Vector3(0), Vector3(1, 0, 0), Vector3(NAN, 0, 0)}) {
        const TriangleMesh mesh = mapped_mesh(k_quarter, a, {1, 0, 0}, {0, 0, 1});
        EXPECT_FALSE(uv_axes(mesh, corners.data(), grey_texture(), axes));
    }
}

TEST(MeshTangents, OfAFlatMapPointAlongU) {
    TriangleMesh mesh = mapped_mesh(k_quarter, {0, 3, 0}, {1, 0, 0}, {0, 0, 1});
    mesh.triangles = {0, 1, 2};
    compute_tangents(mesh);
    // u grows along y, v shrinks along -x: cross(z, y) = -x, so the side is +1.
    for (std::size_t vertex = 0; vertex < 3; ++vertex) expect_tangent(mesh, vertex, {0, 1, 0}, 1);
    TriangleMesh mirrored = mapped_mesh(k_quarter, {0, 3, 0}, {-1, 0, 0}, {0, 0, 1});
    mirrored.triangles = {0, 1, 2};
    compute_tangents(mirrored);
    for (std::size_t vertex = 0; vertex < 3; ++vertex)
        expect_tangent(mirrored, vertex, {0, 1, 0}, -1);
}

TEST(MeshTangents, LieInThePlaneOfTheNormal) {
    const Vector3 normal = glm::normalize(Vector3(1, 0, 2));
    TriangleMesh mesh = mapped_mesh(k_quarter, {1, 0, 0}, {0, 1, 0}, normal);
    mesh.triangles = {0, 1, 2};
    compute_tangents(mesh);
    const Vector3 expected = glm::normalize(Vector3(2, 0, -1));
    for (std::size_t vertex = 0; vertex < 3; ++vertex) expect_tangent(mesh, vertex, expected, -1);
}

TEST(MeshTangents, AreMeansWeightedByAngles) {
    // Two triangles share vertex 0: a right angle with u along x and half a right angle with u
    // along y, each with vertices of its own.
    TriangleMesh mesh = mapped_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {-1, -1, 0}},
                                    {1, 0, 0}, {0, -1, 0}, {0, 0, 1});
    for (const std::size_t vertex : {3U, 4U}) {  // u = y, v = x there
        mesh.uvs[0][2 * vertex] = mesh.positions[3 * vertex + 1];
        mesh.uvs[0][2 * vertex + 1] = mesh.positions[3 * vertex];
    }
    mesh.triangles = {0, 1, 2, 0, 3, 4};
    compute_tangents(mesh);
    expect_tangent(mesh, 0, glm::normalize(Vector3(2, 1, 0)), 1);
    expect_tangent(mesh, 1, {1, 0, 0}, 1);
    expect_tangent(mesh, 3, {0, 1, 0}, 1);
}

TEST(MeshTangents, GivenOnesStay) {
    TriangleMesh mesh = mapped_mesh(k_quarter, {1, 0, 0}, {0, 1, 0}, {0, 0, 1});
    mesh.triangles = {0, 1, 2};
    mesh.tangents[4] = 0.6F, mesh.tangents[5] = 0.8F, mesh.tangents[7] = 1;
    compute_tangents(mesh);
    expect_tangent(mesh, 0, {1, 0, 0}, -1);
    expect_tangent(mesh, 1, {0.6, 0.8, 0}, 1);
}

TEST(MeshTangents, StayZeroWithoutNormalMapOrNormal) {
    TriangleMesh mesh = mapped_mesh(k_quarter, {1, 0, 0}, {0, 1, 0}, {0, 0, 1});
    mesh.triangles = {0, 1, 2};
    mesh.materials[0].normal_map = {};
    compute_tangents(mesh);
    EXPECT_EQ(mesh.tangents, std::vector<float>(12));
    // A normal along u leaves nothing across it.
    TriangleMesh along = mapped_mesh(k_quarter, {1, 0, 0}, {0, 1, 0}, {1, 0, 0});
    along.triangles = {0, 1, 2};
    compute_tangents(along);
    EXPECT_EQ(along.tangents, std::vector<float>(12));
}

}  // namespace
}  // namespace uw
