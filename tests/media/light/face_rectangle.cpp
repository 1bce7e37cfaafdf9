// ctest labels: unit
#include "media/light/light_projection.h"

#include <gtest/gtest.h>

#include <random>

namespace uw::test {
namespace {

// Sides a tenth to 2 m long, around the origin: centres lie inside, beside and far from them.
Bounds random_box(std::mt19937& rng) {
    std::uniform_real_distribution<double> place(-1.5, 1.5), side(0.1, 2.0);
    Bounds box;
    for (int axis = 0; axis < 3; ++axis) {
        box.min[axis] = place(rng);
        box.max[axis] = box.min[axis] + side(rng);
    }
    return box;
}

Point3 random_point(const Bounds& box, std::mt19937& rng) {
    std::uniform_real_distribution<double> share(0, 1);
    Point3 p;
    for (int axis = 0; axis < 3; ++axis)
        p[axis] = box.min[axis] + share(rng) * (box.max[axis] - box.min[axis]);
    return p;
}

TEST(FaceRectangle, HoldsEveryDirectionToTheBox) {
    std::mt19937 rng(11);
    const Bounds around{{-4, -4, -4}, {4, 4, 4}};
    int filled = 0;
    for (int n = 0; n < 300; ++n) {
        const Bounds box = random_box(rng);
        const Point3 center = random_point(around, rng);
        std::array<FaceRectangle, 6> seen;  // by points of the box
        for (int i = 0; i < 4000; ++i) {
            const Vector3 v = random_point(box, rng) - center;
            const int index = cube_face_of(v);
            const CubeFace face(index);
            FaceRectangle& r = seen[static_cast<std::size_t>(index)];
            r.u_min = std::min(r.u_min, face.u(v));
            r.u_max = std::max(r.u_max, face.u(v));
            r.v_min = std::min(r.v_min, face.v(v));
            r.v_max = std::max(r.v_max, face.v(v));
        }
        for (int index = 0; index < 6; ++index) {
            const FaceRectangle& truth = seen[static_cast<std::size_t>(index)];
            const FaceRectangle got = project_box(box, center, CubeFace(index));
            if (truth.empty()) continue;
            ++filled;
            EXPECT_LE(got.u_min, truth.u_min + 1e-12);
            EXPECT_GE(got.u_max, truth.u_max - 1e-12);
            EXPECT_LE(got.v_min, truth.v_min + 1e-12);
            EXPECT_GE(got.v_max, truth.v_max - 1e-12);
            EXPECT_GE(got.u_min, -1 - 1e-12);
            EXPECT_LE(got.u_max, 1 + 1e-12);
        }
    }
    EXPECT_GT(filled, 400);
}

TEST(FaceRectangle, IsTheClosedFormOfABoxAhead) {
    // Its near side, at depth 2, is the widest.
    const FaceRectangle r = project_box({{-0.5, 0.2, 2}, {1, 0.6, 4}}, {0, 0, 0}, CubeFace(4));
    EXPECT_NEAR(r.u_min, -0.25, 1e-15);  // u is x, v is y on the face along +z
    EXPECT_NEAR(r.u_max, 0.5, 1e-15);
    EXPECT_NEAR(r.v_min, 0.05, 1e-15);
    EXPECT_NEAR(r.v_max, 0.3, 1e-15);
}

TEST(FaceRectangle, IsEmptyBehindAndBesideTheFace) {
    const Bounds box{{-0.5, -0.5, 2}, {0.5, 0.5, 4}};
    for (const int face : {0, 1, 2, 3, 5})
        EXPECT_TRUE(project_box(box, {0, 0, 0}, CubeFace(face)).empty());
}

TEST(FaceRectangle, IsTheWholeFaceFromInsideTheBox) {
    for (int face = 0; face < 6; ++face) {
        const FaceRectangle r = project_box({{-1, -1, -1}, {1, 1, 1}}, {0.9, 0, 0}, CubeFace(face));
        EXPECT_EQ(r.u_min, -1);
        EXPECT_EQ(r.u_max, 1);
        EXPECT_EQ(r.v_min, -1);
        EXPECT_EQ(r.v_max, 1);
    }
}

TEST(FaceRectangle, IsTheWholeFaceFromASideOfTheBox) {
    const Bounds box{{-1, -1, -1}, {1, 1, 1}};
    for (int axis = 0; axis < 3; ++axis) {
        for (const double side : {-1.0, 1.0}) {
            Point3 center{0.2, 0.3, 0.4};
            center[axis] = side;
            for (int face = 0; face < 6; ++face) {
                const FaceRectangle r = project_box(box, center, CubeFace(face));
                EXPECT_EQ(r.u_min, -1) << axis << side;
                EXPECT_EQ(r.u_max, 1) << axis << side;
                EXPECT_EQ(r.v_min, -1) << axis << side;
                EXPECT_EQ(r.v_max, 1) << axis << side;
            }
        }
    }
}

TEST(FaceRectangle, ChordsThroughASlabAreItsThicknessOverTheCosine) {
    const Bounds slab{{-9, -9, 2}, {9, 9, 2.5}};
    const double got = integrate_chords(slab, {0, 0, 0}, CubeFace(4), {-1, 1, -1, 1});
    double truth = 0;  // int sqrt(1 + u^2 + v^2) du dv, by the midpoint rule
    constexpr int k_steps = 500;
    for (int j = 0; j < k_steps; ++j) {
        for (int i = 0; i < k_steps; ++i) {
            const double u = (2.0 * i + 1) / k_steps - 1, v = (2.0 * j + 1) / k_steps - 1;
            truth += 0.5 * std::sqrt(1 + u * u + v * v) * 4 / (k_steps * k_steps);
        }
    }
    EXPECT_NEAR(got, truth, 1e-3 * truth);  // both sums are of second order
}

}  // namespace
}  // namespace uw::test
