// ctest labels: analytic metamorphic
#include "media/volumes/grid_field.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "tests/support/field_maker.h"

namespace uw {
namespace {

using test::bumpy;
using test::bumpy_fixture;
using test::bumpy_trilinear;
using test::column_of;
using test::FieldMaker;
using test::k_quantum;
using test::profile_column;
using test::transforms;
using test::value_at;
using test::VdbFixture;

TEST(GridField, SamplesAreTrilinearUnderAnyTransform) {
    FieldMaker maker;
    std::mt19937 random(1);
    std::uniform_real_distribution<double> anywhere(-12, 18);
    for (const auto& [name, file_from_index] : transforms()) {
        VdbFixture fixture = bumpy_fixture();
        fixture.file_from_index = file_from_index;
        const auto field = maker.field(fixture);
        for (int n = 0; n < 2000; ++n) {
            const Point3 u{anywhere(random), anywhere(random), anywhere(random)};
            EXPECT_NEAR(value_at(*field, file_from_index * u), bumpy_trilinear(u), k_quantum)
                << name;
        }
    }
}

TEST(GridField, CellsSitHalfAVoxelFurther) {
    FieldMaker maker;
    VdbFixture fixture = bumpy_fixture();
    fixture.file_from_index = Affine::scale({0.04, 0.07, -0.02});
    const auto node = maker.field(fixture, Centering::node);
    EXPECT_EQ(maker.reports[0].placement.centering, Centering::node);
    const Bounds node_bounds = maker.reports[0].bounds;
    const auto cell = maker.field(fixture, Centering::cell);
    EXPECT_EQ(maker.reports[0].placement.centering, Centering::cell);
    const Vector3 shift(0.02, 0.035, -0.01);
    EXPECT_NEAR(glm::length(maker.reports[0].bounds.min - node_bounds.min - shift), 0, 1e-12);
    std::mt19937 random(2);
    std::uniform_real_distribution<double> anywhere(-1, 1);
    for (int n = 0; n < 500; ++n) {
        const Point3 x{anywhere(random), anywhere(random), anywhere(random)};
        EXPECT_NEAR(value_at(*cell, x + shift), value_at(*node, x), 1e-9);
    }
    // Centred on nodes, voxel (0, 0, 0) itself.
    EXPECT_NEAR(value_at(*node, {0, 0, 0}), bumpy(0, 0, 0), k_quantum);
}

TEST(GridField, UpZIsTurnedUpright) {
    FieldMaker maker;
    VolumeDesc desc = maker.volume(bumpy_fixture(), Centering::node, UpAxis::z);
    desc.world_from_upright = Affine::translation({10, 20, 30}) * Affine::scale(Vector3(2.0));
    const auto field = maker.load({desc}, {{{GridLoad{0, 1.0}}}}, 1);
    // The file's (1, 2, 3) is upright (1, 3, -2).
    EXPECT_NEAR(value_at(*field, {10 + 2, 20 + 6, 30 - 4}), bumpy(1, 2, 3), k_quantum);
    EXPECT_EQ(maker.reports[0].metres_per_voxel, Vector3(2.0));
}

/// Composite midpoint rule over the definition of the interpolant.
double bumpy_column(const Affine& file_from_index, const Point3& a, const Point3& b) {
    const Affine index_from_file = file_from_index.inverse();
    constexpr int n = 40000;
    double sum = 0;
    for (int i = 0; i < n; ++i)
        sum += bumpy_trilinear(index_from_file * (a + (i + 0.5) / n * (b - a)));
    return sum / n * distance(a, b);
}

TEST(GridField, ColumnsAreTheIntegralsOfTheInterpolant) {
    FieldMaker maker;
    for (const auto& [name, file_from_index] : transforms()) {
        VdbFixture fixture = bumpy_fixture();
        fixture.file_from_index = file_from_index;
        const auto field = maker.field(fixture);
        const std::array<std::array<Point3, 2>, 6> index_segments{
            {{{{-20, -9, -15}, {21, 19, 24}}},       // across, from outside to outside
             {{{0.3, 1.1, 2.7}, {6.2, 3.3, 14.9}}},  // inside
             {{{-20, 4.3, 5.2}, {20, 4.3, 5.2}}},    // along an axis
             {{{3, 5, -20}, {3, 5, 30}}},            // along voxel faces
             {{{16, 7, 40}, {16, 7, -40}}},          // in the empty half of a block, misses
             {{{30, 20, -9}, {-12, 6, 0}}}}};        // grazes
        for (const auto& [u, v] : index_segments) {
            const Point3 a = file_from_index * u, b = file_from_index * v;
            const double expected = bumpy_column(file_from_index, a, b);
            // Quantisation, and the midpoint rule over 40000 steps of at most 2e-3 voxels.
            const double tolerance = k_quantum * distance(a, b) + 1e-6;
            EXPECT_NEAR(column_of(*field, a, b), expected, tolerance) << name;
            EXPECT_NEAR(column_of(*field, b, a), expected, tolerance) << name;
            // The profile's linear pieces differ by O(step^2) of the field's curvature.
            EXPECT_NEAR(profile_column(*field, a, b), expected, 4e-3 * expected + 1e-6) << name;
        }
    }
}

TEST(GridField, ColumnsAdd) {
    FieldMaker maker;
    VdbFixture fixture = bumpy_fixture();
    fixture.boxes = {{{40, 0, 0}, {359, 150, 150}, 0.7}};  // with tiles of 128^3
    fixture.file_from_index = transforms()[4].file_from_index;
    const auto field = maker.field(fixture);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> anywhere(-40, 400), fraction(0, 1);
    for (int n = 0; n < 500; ++n) {
        const Point3 a =
            fixture.file_from_index * Point3{anywhere(random), anywhere(random), anywhere(random)};
        const Point3 c =
            fixture.file_from_index * Point3{anywhere(random), anywhere(random), anywhere(random)};
        const Point3 b = a + fraction(random) * (c - a);
        const double whole = column_of(*field, a, c);
        // Exact in each part; what is left is double rounding over some hundred cells.
        EXPECT_NEAR(column_of(*field, a, b) + column_of(*field, b, c), whole, 1e-10 * (1 + whole));
    }
    EXPECT_EQ(column_of(*field, {1, 2, 3}, {1, 2, 3}), 0);
}

TEST(GridField, ConstantGridIsMetricUnderAnyTransform) {
    FieldMaker maker;
    for (const auto& [name, file_from_index] : transforms()) {
        VdbFixture fixture;
        fixture.boxes = {{{0, 0, 0}, {199, 139, 99}, 0.25}};
        fixture.file_from_index = file_from_index;
        const auto field = maker.field(fixture);
        const Point3 a = file_from_index * Point3{3, 2, 5},
                     b = file_from_index * Point3{190, 130, 91};
        EXPECT_NEAR(column_of(*field, a, b), 0.25 * distance(a, b), 1e-12) << name;
        EXPECT_NEAR(profile_column(*field, a, b), 0.25 * distance(a, b), 1e-12) << name;
    }
}

TEST(GridField, ConstantGridForgetsItsVoxelSize) {
    FieldMaker maker;
    VdbFixture fine;
    fine.boxes = {{{0, 0, 0}, {63, 63, 63}, 2.0}};
    fine.file_from_index = Affine::scale(Vector3(0.01));
    VdbFixture coarse = fine;
    coarse.boxes[0].max = {31, 31, 31};
    coarse.file_from_index = Affine::scale(Vector3(0.02));
    const auto a = maker.field(fine, Centering::cell);
    const auto b = maker.field(coarse, Centering::cell);
    // A cell-centred constant box of side L ramps from 0 to its value over one voxel, centred on
    // the box's face: straight through, the integral is value * L whatever the voxel.
    for (const Vector3 along : {Vector3(1, 0, 0), Vector3(0, 1, 0), Vector3(0, 0, -1)}) {
        const Point3 middle{0.32, 0.31, 0.33};
        EXPECT_NEAR(column_of(*a, middle - along, middle + along), 2 * 0.64, 1e-12);
        EXPECT_NEAR(column_of(*b, middle - along, middle + along), 2 * 0.64, 1e-12);
        EXPECT_NEAR(profile_column(*a, middle - along, middle + along), 2 * 0.64, 1e-9);
    }
}

/// exp(-r^2 / 2 sigma^2) about the origin, cut off where it falls below 1e-7.
VdbFixture gaussian(int voxels_per_sigma, double sigma) {
    const int radius = static_cast<int>(5.7 * voxels_per_sigma);
    VdbFixture fixture;
    fixture.min = {-radius, -radius, -radius};
    fixture.max = {radius, radius, radius};
    const double h = 1.0 / voxels_per_sigma;
    fixture.value = [h](int i, int j, int k) {
        return std::exp(-0.5 * h * h * (i * i + j * j + k * k));
    };
    fixture.file_from_index = Affine::scale(Vector3(sigma * h));
    return fixture;
}

TEST(GridField, GaussianColumnConvergesWithTheSquareOfTheVoxel) {
    FieldMaker maker;
    const double sigma = 0.3;
    std::array<double, 3> error{};
    for (std::size_t level = 0; level < 3; ++level) {
        const auto field = maker.field(gaussian(2 << level, sigma));
        const Vector3 direction = glm::normalize(Vector3(0.3, 0.8, -0.5));
        const Vector3 aside = glm::normalize(glm::cross(direction, Vector3(1, 0, 0)));
        for (const double miss : {0.0, 0.11, 0.35}) {  // distance of the line from the centre
            const Point3 middle = at_origin_plus(miss * aside);
            const double expected = sigma * std::sqrt(2 * std::numbers::pi) *
                                    std::exp(-0.5 * miss * miss / (sigma * sigma));
            const double column =
                column_of(*field, middle - 3.0 * direction, middle + 3.0 * direction);
            error[level] = std::max(error[level], std::abs(column - expected) / expected);
        }
    }
    // Linear interpolation: the error falls by 4 per halving of the voxel.
    EXPECT_NEAR(std::log2(error[0] / error[1]), 2, 0.35) << error[0] << " " << error[1];
    EXPECT_NEAR(std::log2(error[1] / error[2]), 2, 0.35) << error[1] << " " << error[2];
    EXPECT_LT(error[2], 0.01);
}

TEST(GridField, HalvesAddToTheWhole) {
    FieldMaker maker;
    VdbFixture whole = bumpy_fixture(), left = whole, right = whole;
    left.max[0] = 2;
    right.min[0] = 3;
    const auto one = maker.field(whole);
    const auto two = maker.load({maker.volume(left), maker.volume(right)},
                                {{{GridLoad{0, 1.0}}}, {{GridLoad{0, 1.0}}}}, 1);
    std::mt19937 random(4);
    std::uniform_real_distribution<double> anywhere(-14, 20);
    for (int n = 0; n < 300; ++n) {
        const Point3 a{anywhere(random), anywhere(random), anywhere(random)};
        const Point3 b{anywhere(random), anywhere(random), anywhere(random)};
        // Exact but for the blocks through which the cut goes: these are quantised anew.
        EXPECT_NEAR(value_at(*two, a), value_at(*one, a), 2 * k_quantum);
        EXPECT_NEAR(column_of(*two, a, b), column_of(*one, a, b), 2 * k_quantum * distance(a, b));
        EXPECT_NEAR(profile_column(*two, a, b), profile_column(*one, a, b),
                    5e-3 * column_of(*one, a, b) + 1e-4);
    }
}

TEST(GridField, SlabsAreTheWhole) {
    FieldMaker maker;
    VdbFixture fixture = bumpy_fixture();
    fixture.min = {-40, -3, -6};
    fixture.max = {70, 14, 15};
    fixture.boxes = {{{80, -20, -20}, {239, 150, 150}, 0.6}};  // tiles to be cut, too
    const auto whole = maker.field(fixture);
    EXPECT_EQ(maker.reports[0].bricks, 1U);
    const GridStatistics statistics = maker.reports[0].statistics;
    const auto slabs = maker.field(fixture, Centering::node, UpAxis::y, /*slab_bytes=*/1);
    EXPECT_GT(maker.reports[0].bricks, 4U);
    EXPECT_EQ(maker.reports[0].statistics.active_voxels, statistics.active_voxels);
    EXPECT_EQ(maker.reports[0].statistics.min, statistics.min);
    EXPECT_EQ(maker.reports[0].statistics.max, statistics.max);
    EXPECT_NEAR(maker.reports[0].statistics.mean, statistics.mean, 1e-12);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> anywhere(-60, 260);
    for (int n = 0; n < 300; ++n) {
        const Point3 a{anywhere(random), 0.1 * anywhere(random), 0.1 * anywhere(random)};
        const Point3 b{anywhere(random), 0.1 * anywhere(random), 0.1 * anywhere(random)};
        const double column = column_of(*whole, a, b);
        EXPECT_NEAR(value_at(*slabs, a), value_at(*whole, a), 1e-12);
        EXPECT_NEAR(column_of(*slabs, a, b), column, 1e-10 * (1 + column));
    }
}

}  // namespace
}  // namespace uw
