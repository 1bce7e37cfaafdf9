// ctest labels: unit
#include "core/geometry/polygon.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "core/base/error.h"
#include "core/base/vector_math.h"
#include "tests/support/message_of.h"

namespace uw {
namespace {

struct PolygonOutline {
    std::vector<float> positions;
    std::vector<std::uint32_t> corners;
};

/// A polygon in the plane, laid into space by two axes.
PolygonOutline polygon_of(const std::vector<glm::dvec2>& points, const Vector3& u = {1, 0, 0},
                          const Vector3& v = {0, 1, 0}) {
    PolygonOutline result;
    for (const glm::dvec2& p : points) {
        const Vector3 at = p.x * u + p.y * v;
        for (int axis = 0; axis < 3; ++axis)
            result.positions.push_back(static_cast<float>(at[axis]));
    }
    result.corners.resize(points.size());
    std::iota(result.corners.begin(), result.corners.end(), 0U);
    return result;
}

std::vector<std::uint32_t> cut_into_triangles(const PolygonOutline& polygon) {
    std::vector<std::uint32_t> triangles;
    triangulate_polygon(polygon.corners, polygon.positions, "a.obj", triangles);
    return triangles;
}

Vector3 corner_at(const PolygonOutline& polygon, std::uint32_t vertex) {
    const float* p = &polygon.positions[3 * std::size_t{vertex}];
    return {p[0], p[1], p[2]};
}

/// The area vectors of the triangles, and of the polygon by the cross products of its edges.
std::vector<Vector3> triangle_areas(const PolygonOutline& polygon) {
    const std::vector<std::uint32_t> triangles = cut_into_triangles(polygon);
    std::vector<Vector3> areas;
    for (std::size_t t = 0; t < triangles.size(); t += 3) {
        const Vector3 a = corner_at(polygon, triangles[t]);
        areas.push_back(0.5 * glm::cross(corner_at(polygon, triangles[t + 1]) - a,
                                         corner_at(polygon, triangles[t + 2]) - a));
    }
    return areas;
}

Vector3 outline_area(const PolygonOutline& polygon) {
    Vector3 area(0);
    for (std::size_t i = 0; i < polygon.corners.size(); ++i)
        area +=
            0.5 * glm::cross(corner_at(polygon, polygon.corners[i]),
                             corner_at(polygon, polygon.corners[(i + 1) % polygon.corners.size()]));
    return area;
}

/// All triangles turn the way of the polygon and fill its area: then none lies outside of it.
void expect_filled(const PolygonOutline& polygon) {
    const std::vector<Vector3> areas = triangle_areas(polygon);
    const Vector3 whole = outline_area(polygon);
    EXPECT_EQ(areas.size(), polygon.corners.size() - 2);
    double sum = 0;
    for (const Vector3& area : areas) {
        EXPECT_GE(glm::dot(area, whole), -1e-9);
        sum += glm::length(area);
    }
    EXPECT_NEAR(sum, glm::length(whole), 1e-5 * glm::length(whole));
}

const std::vector<glm::dvec2> k_arrowhead{{2, 0}, {4, 4}, {2, 2}, {0, 4}};

std::vector<glm::dvec2> star_corners(int points) {
    std::vector<glm::dvec2> corners;
    for (int i = 0; i < 2 * points; ++i) {
        const double angle = std::numbers::pi * i / points, radius = i % 2 == 0 ? 1 : 0.3;
        corners.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    }
    return corners;
}

TEST(Polygon, FewerThanThreeCornersGiveNothing) {
    EXPECT_TRUE(cut_into_triangles(polygon_of({})).empty());
    EXPECT_TRUE(cut_into_triangles(polygon_of({{0, 0}, {1, 0}})).empty());
}

TEST(Polygon, ATriangleIsItself) {
    EXPECT_EQ(cut_into_triangles(polygon_of({{0, 0}, {1, 0}, {0, 1}})),
              (std::vector<std::uint32_t>{0, 1, 2}));
}

TEST(Polygon, ConcaveOutlinesAreKept) {
    expect_filled(polygon_of(k_arrowhead));
    for (const int points : {3, 5, 12}) expect_filled(polygon_of(star_corners(points)));
    // A comb: every second corner is concave.
    std::vector<glm::dvec2> comb{{0, 0}, {10, 0}};
    for (int i = 10; i-- > 0;) {
        comb.emplace_back(i + 0.9, 3);
        comb.emplace_back(i + 0.1, 1);
    }
    expect_filled(polygon_of(comb));
}

TEST(Polygon, WhateverTheirPlaneAndSense) {
    for (const auto& [u, v] : {std::pair{Vector3(0, 1, 0), Vector3(0, 0, 1)},
                               {Vector3(0, 0, 1), Vector3(1, 0, 0)},
                               {Vector3(1, 0, 0), Vector3(0, -1, 0)},
                               {Vector3(1, 2, 0.5), Vector3(-1, 0.4, 2)}}) {
        expect_filled(polygon_of(k_arrowhead, u, v));
        std::vector<glm::dvec2> reversed(k_arrowhead.rbegin(), k_arrowhead.rend());
        expect_filled(polygon_of(reversed, u, v));
    }
}

TEST(Polygon, AnyCornerMayBeTheFirst) {
    std::vector<glm::dvec2> corners = k_arrowhead;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        std::rotate(corners.begin(), corners.begin() + 1, corners.end());
        expect_filled(polygon_of(corners));
    }
}

TEST(Polygon, HolesAreReachedByBridges) {
    // A square with a square hole, walked along a bridge there and back: area 16 - 4.
    const PolygonOutline ring = polygon_of({{0, 0},
                                            {4, 0},
                                            {4, 4},
                                            {0, 4},
                                            {0, 0},  //
                                            {1, 1},
                                            {1, 3},
                                            {3, 3},
                                            {3, 1},
                                            {1, 1}});
    EXPECT_NEAR(glm::length(outline_area(ring)), 12, 1e-6);
    expect_filled(ring);
}

TEST(Polygon, WithoutAreaOrCrossingItselfHasItsNumberOfTriangles) {
    EXPECT_EQ(cut_into_triangles(polygon_of({{0, 0}, {1, 0}, {2, 0}, {3, 0}})).size(), 6U);
    EXPECT_EQ(cut_into_triangles(polygon_of({{0, 0}, {1, 1}, {1, 0}, {0, 1}})).size(), 6U);
    EXPECT_EQ(cut_into_triangles(polygon_of({{1, 1}, {1, 1}, {1, 1}, {1, 1}, {1, 1}})).size(), 9U);
}

// A convex one of any size is a fan.
TEST(Polygon, ManyCornersKeepTheirOutline) {
    std::vector<glm::dvec2> circle;
    for (int i = 0; i < 1001; ++i) {
        const double angle = 2 * std::numbers::pi * i / 1001;
        circle.emplace_back(std::cos(angle), std::sin(angle));
    }
    expect_filled(polygon_of(circle));
    const std::vector<std::uint32_t> triangles = cut_into_triangles(polygon_of(circle));
    for (std::size_t t = 0; t < triangles.size(); t += 3) EXPECT_EQ(triangles[t], 0U);
    expect_filled(polygon_of(star_corners(20000)));
}

/// Once around for each step, so that almost all edges cross.
std::vector<glm::dvec2> wound_corners(int count, int step) {
    std::vector<glm::dvec2> corners;
    for (int i = 0; i < count; ++i) {
        const double angle = 2 * std::numbers::pi * i * step / count;
        corners.emplace_back((1 + 0.3 * (i % 3)) * std::cos(angle), std::sin(angle));
    }
    return corners;
}

// What a file of some kilobytes can ask for does not take minutes: larger ones that cannot be cut
// in time proportional to their corners are refused.
TEST(Polygon, LargeOnesThatCrossThemselvesAreRefused) {
    EXPECT_EQ(cut_into_triangles(polygon_of(wound_corners(999, 7))).size(), 3U * 997);
    const auto refusal = [](const std::vector<glm::dvec2>& corners) {
        return test::message_of<InputError>([&] { cut_into_triangles(polygon_of(corners)); });
    };
    EXPECT_EQ(refusal(wound_corners(100000, 31337)).substr(0, 35),
              "a.obj: a polygon of 100000 corners ");
}

// Corners that are no numbers have triangles, too, which are dropped as those of any face.
TEST(Polygon, CornersThatAreNoNumbers) {
    PolygonOutline star = polygon_of(star_corners(5));
    star.positions[4] = std::numeric_limits<float>::quiet_NaN();
    star.positions[9] = std::numeric_limits<float>::infinity();
    EXPECT_EQ(cut_into_triangles(star).size(), 3U * 8);
}

}  // namespace
}  // namespace uw
