// ctest labels: unit analytic
#include "media/light/light_projection.h"

#include <gtest/gtest.h>

#include "tests/support/random_direction.h"

namespace uw::test {
namespace {

TEST(CubeFace, EachDirectionFallsOnOneFaceWithinItsSquare) {
    std::mt19937 rng(1);
    for (int n = 0; n < 2000; ++n) {
        const Vector3 direction = random_direction(rng);
        int faces = 0;
        for (int index = 0; index < 6; ++index) {
            const CubeFace face(index);
            if (face.depth(direction) <= 0) continue;
            const double u = face.u(direction), v = face.v(direction);
            const bool inside = std::abs(u) <= 1 && std::abs(v) <= 1;
            faces += inside ? 1 : 0;
            EXPECT_EQ(index == cube_face_of(direction), inside);
            // The face's point is the direction again.
            const Vector3 back = glm::normalize(face.direction(u, v));
            EXPECT_LT(glm::length(back - direction), 1e-14);
        }
        EXPECT_EQ(faces, 1);
    }
}

TEST(CubeFace, FacesLookAlongTheirAxes) {
    for (int index = 0; index < 6; ++index) {
        Vector3 axis(0);
        axis[index / 2] = index % 2 == 0 ? 1 : -1;
        EXPECT_EQ(cube_face_of(axis), index);
        EXPECT_EQ(CubeFace(index).direction(0, 0), axis);
        EXPECT_EQ(CubeFace(index).depth(5.0 * axis), 5);
    }
}

TEST(CubeFace, LinesInSpaceAreLinesOnAFace) {
    const CubeFace face(4);  // +z: u is x / z, v is y / z
    const Vector3 a(0.2, -0.5, 1), b(1.5, 0.3, 3);
    const Vector3 middle = a + 0.3 * (b - a);
    const double cross = (face.u(middle) - face.u(a)) * (face.v(b) - face.v(a)) -
                         (face.v(middle) - face.v(a)) * (face.u(b) - face.u(a));
    EXPECT_NEAR(cross, 0, 1e-15);
}

void expect_split(const Ray& ray, const Point3& center, const Interval& stretch) {
    std::vector<FaceSegment> segments{{3, {7, 8}}};  // is overwritten
    split_by_face(ray, center, stretch, segments);
    ASSERT_FALSE(segments.empty());
    EXPECT_EQ(segments.front().interval.begin, stretch.begin);
    EXPECT_EQ(segments.back().interval.end, stretch.end);
    for (std::size_t i = 0; i < segments.size(); ++i) {
        const auto& [face, part] = segments[i];
        EXPECT_LT(part.begin, part.end);
        if (i > 0) {
            EXPECT_EQ(part.begin, segments[i - 1].interval.end);
            EXPECT_NE(face, segments[i - 1].face);
        }
        for (double t = 0.01; t < 1; t += 0.07)
            EXPECT_EQ(cube_face_of(ray.at(part.begin + t * part.length()) - center), face);
    }
    EXPECT_LE(segments.size(), 5U);  // a line crosses no more faces of a cube's cones
}

TEST(CubeFace, SplitsRaysWhereTheFaceChanges) {
    std::mt19937 rng(2);
    std::uniform_real_distribution<double> offset(-2, 2);
    const Point3 center{0.3, -0.2, 1};
    for (int n = 0; n < 500; ++n) {
        const Ray ray{{offset(rng), offset(rng), offset(rng)}, random_direction(rng)};
        expect_split(ray, center, {0, 6});
        expect_split(ray, center, {1, 1.5});
    }
}

TEST(CubeFace, SplitsRaysAlongAxesAndThroughTheCentre) {
    std::vector<FaceSegment> segments;
    split_by_face({{0, 0, -2}, {0, 0, 1}}, {0, 0, 0}, {0, 5}, segments);
    ASSERT_EQ(segments.size(), 2U);
    EXPECT_EQ(segments[0].face, 5);
    EXPECT_EQ(segments[1].face, 4);
    EXPECT_NEAR(segments[0].interval.end, 2, 1e-15);
    split_by_face({{1, 0, 0}, {0, 1, 0}}, {0, 0, 0}, {0, 5}, segments);
    ASSERT_EQ(segments.size(), 2U);
    EXPECT_EQ(segments[0].interval.end, 1);
}

}  // namespace
}  // namespace uw::test
