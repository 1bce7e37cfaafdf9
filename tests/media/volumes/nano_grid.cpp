// ctest labels: unit analytic
#include "media/volumes/loaded_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "media/volumes/grid_field.h"
#include "tests/support/field_maker.h"
#include "tests/support/vdb/vdb_loading.h"

namespace uw {
namespace {

using test::bumpy_trilinear;
using test::k_quantum;

double stored_sum(const ConcentrationField& field) {
    double sum = 0;
    for (const GridVolume& volume : dynamic_cast<const GridField&>(field).volumes())
        for (const NanoGrid& brick : volume.bricks()) sum += brick.stored_sum();
    return sum;
}

class NanoGridTest : public testing::Test {
  protected:
    /// The one brick of a file made of `fixture`.
    NanoGrid grid(const test::VdbFixture& fixture) const {
        test::write_fixture(dir_ / "a.vdb", {fixture});
        return test::load(dir_ / "a.vdb", fixture.name).bricks.at(0);
    }
    test::TempDir dir_;
};

std::vector<LatticeLine> random_lines(int count) {
    std::mt19937 rng(4);
    std::uniform_real_distribution<double> anywhere(-14, 20);
    std::vector<LatticeLine> lines;
    for (int n = 0; n < count; ++n) {
        const Point3 a{anywhere(rng), anywhere(rng), anywhere(rng)};
        const Point3 b{anywhere(rng), anywhere(rng), anywhere(rng)};
        lines.push_back({a, b - a});
    }
    lines.push_back({{0, 3, 4}, {9, 0, 0}});           // along lattice lines
    lines.push_back({{-12, -6, -9}, {32, 32, 32}});    // through lattice points
    lines.push_back({{0.5, 0.5, 0.5}, {0, 0, 1e-9}});  // hardly anywhere
    return lines;
}

TEST_F(NanoGridTest, SamplesAreTrilinear) {
    const NanoGrid bumpy = grid(test::bumpy_fixture());
    std::mt19937 rng(1);
    std::uniform_real_distribution<double> anywhere(-12, 18);
    for (int n = 0; n < 2000; ++n) {
        const Point3 p{anywhere(rng), anywhere(rng), anywhere(rng)};
        EXPECT_NEAR(bumpy.sample(p), bumpy_trilinear(p), k_quantum);
    }
    for (int i = -9; i <= 10; i += 3)
        EXPECT_NEAR(bumpy.sample({double(i), 2, 7}), test::bumpy(i, 2, 7), k_quantum);
}

TEST_F(NanoGridTest, SamplesAlongALineAreThoseOfItsPoints) {
    const NanoGrid bumpy = grid(test::bumpy_fixture());
    for (const LatticeLine& line : random_lines(50)) {
        std::vector<double> t, values;
        for (double at = -0.2; at < 1.2; at += 0.013) t.push_back(at);
        values.assign(t.size(), 10);  // what is there stays
        bumpy.add_samples(line, t, values);
        for (std::size_t i = 0; i < t.size(); ++i)
            EXPECT_NEAR(values[i], 10 + bumpy.sample(line.origin + t[i] * line.direction), 1e-12);
    }
}

TEST_F(NanoGridTest, IntegralsAreThoseOfTheInterpolant) {
    const NanoGrid bumpy = grid(test::bumpy_fixture());
    for (const LatticeLine& line : random_lines(20)) {
        constexpr int k_steps = 20000;
        double sum = 0;
        for (int i = 0; i < k_steps; ++i)
            sum += bumpy.sample(line.origin + (i + 0.5) / k_steps * line.direction) / k_steps;
        // Midpoints: the interpolant bends by its own size where a cell of 1/30 of the line begins.
        EXPECT_NEAR(bumpy.integrate(line), sum, 1e-5);
    }
}

// Between two lattice planes the interpolant is a cubic along a line, which two Gauss points
// integrate exactly.
double integral_by_cells(const NanoGrid& grid, const LatticeLine& line) {
    std::vector<double> knots{0, 1};
    for (int axis = 0; axis < 3; ++axis)
        for (int plane = -200; plane <= 200 && line.direction[axis] != 0; ++plane) {
            const double t = (plane - line.origin[axis]) / line.direction[axis];
            if (t > 0 && t < 1) knots.push_back(t);
        }
    std::ranges::sort(knots);
    double sum = 0;
    for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
        const double half = 0.5 * (knots[i + 1] - knots[i]), middle = knots[i] + half;
        for (const double side : {-1.0, 1.0})
            sum += half * grid.sample(line.origin +
                                      (middle + side * half / std::sqrt(3.0)) * line.direction);
    }
    return sum;
}

TEST_F(NanoGridTest, IntegralsAreExactInEveryCell) {
    test::VdbFixture fixture = test::bumpy_fixture();
    fixture.boxes = {{{16, -8, -8}, {31, 15, 15}, 0.5}};  // tiles beside blocks
    const NanoGrid grid_of_both = grid(fixture);
    std::vector<LatticeLine> lines = random_lines(300);
    for (int axis = 0; axis < 3; ++axis)
        for (const double from : {-9.0, 30.0}) {
            // Along an axis, in cells at blocks' faces and between, and along lattice lines.
            for (const double beside : {7.5, 7.0, 3.0, -0.5}) {
                LatticeLine line{Point3(beside), Vector3(0)};
                line.origin[axis] = from;
                line.direction[axis] = 21 - 2 * from;
                lines.push_back(line);
            }
            lines.push_back({Point3(from), Vector3(21 - 2 * from)});  // through lattice points
        }
    for (const LatticeLine& line : lines)
        EXPECT_NEAR(grid_of_both.integrate(line), integral_by_cells(grid_of_both, line), 1e-13);
}

TEST_F(NanoGridTest, OutsideItsStretchesAllIsZero) {
    test::VdbFixture two = test::bumpy_fixture();
    two.boxes = {{{64, 0, 0}, {127, 63, 63}, 0.5}};  // a tile, far from the rest
    const NanoGrid grid_of_two = grid(two);
    std::vector<LatticeLine> lines = random_lines(50);
    lines.push_back({{-20, 5, 5}, {200, 1, 2}});
    for (const LatticeLine& line : lines) {
        std::vector<GridStretch> stretches;
        grid_of_two.append_intervals(line, 0, 1, stretches);
        double last = 0;
        for (const GridStretch& stretch : stretches) {
            EXPECT_LT(stretch.begin, stretch.end);
            EXPECT_GE(stretch.begin, last);
            last = stretch.end;
        }
        EXPECT_LE(last, 1);
        for (double t = 0; t <= 1; t += 0.0037) {
            const double value = grid_of_two.sample(line.origin + t * line.direction);
            const auto around = std::ranges::find_if(
                stretches, [&](const GridStretch& s) { return t >= s.begin && t <= s.end; });
            if (around == stretches.end()) {
                EXPECT_EQ(value, 0) << t;
            } else if (around->constant) {
                EXPECT_NEAR(value, 0.5, k_quantum) << t;
            }
        }
    }
}

/// What makes a line long without making the file large: voxels far apart, on the faces of blocks
/// and beside them, blocks of one value or of two in turn, a few or many of them.
std::vector<test::VdbFixture> hostile_fixtures() {
    std::vector<test::VdbFixture> fixtures;
    const auto add = [&](std::vector<test::VdbBox> boxes) {
        fixtures.emplace_back().boxes = std::move(boxes);
    };
    const auto voxel = [](int i, int j, int k) { return test::VdbBox{{i, j, k}, {i, j, k}, 1}; };
    for (const int far : {1000, 1'000'000, (1 << 30) - 2}) {
        add({voxel(0, 0, 0), voxel(far, 0, 0)});
        add({voxel(-far, -1, 4095), voxel(far, -1, 4095)});
        add({voxel(-far, -far, -far), voxel(far, far, far)});
    }
    std::vector<test::VdbBox> dust, cube, chequered;
    for (int n = 0; n < 60; ++n)
        dust.push_back(voxel(n * 7919 % 1'000'003, n * 104'729 % 999'983, n * 31'337 % 999'979));
    for (int i = 0; i < 12; ++i)
        for (int j = 0; j < 12; ++j)
            for (int k = 0; k < 12; ++k) {
                const std::array<int, 3> low{4096 * i, 4096 * j, 4096 * k};
                const std::array<int, 3> high{low[0] + 4095, low[1] + 4095, low[2] + 4095};
                cube.push_back({low, high, 1});
                chequered.push_back({low, high, 1.0 + (i + j + k) % 2});
            }
    add(dust);
    add(cube);
    add(chequered);
    return fixtures;
}

/// The work of a line is that of the blocks and tiles that it meets, not of the voxels between: of
/// a line along a face between tiles, too, and of emptiness however wide. A file of a few kilobytes
/// would otherwise take minutes.
TEST_F(NanoGridTest, TheWorkOfALineIsThatOfWhatTheFileHolds) {
    for (const test::VdbFixture& fixture : hostile_fixtures()) {
        const NanoGrid hostile = grid(fixture);
        const Bounds& box = hostile.support();
        const Vector3 size = box.max - box.min;
        for (int axis = 0; axis < 3; ++axis)
            for (const double u : {0.0, 1e-7, 0.3, 0.5, 1.0})
                for (const double v : {0.0, 0.4, 0.5, 1.0}) {
                    LatticeLine line{box.min, Vector3(0)};
                    line.origin[(axis + 1) % 3] += u * size[(axis + 1) % 3];
                    line.origin[(axis + 2) % 3] += v * size[(axis + 2) % 3];
                    line.direction[axis] = size[axis];
                    // Through emptiness a line meets some twenty blocks of doubling edges on the
                    // way to each of the voxels near it, and layers between them; of the cubes
                    // twelve and as many layers.
                    EXPECT_LE(hostile.regions_along(line), 400U) << size[axis] << " " << u << v;
                    std::vector<GridStretch> stretches;
                    hostile.append_intervals(line, 0, 1, stretches);
                    EXPECT_LE(stretches.size(), 200U);
                }
    }
}

/// The integral along a line over voxels far apart is that over each of them.
TEST_F(NanoGridTest, EmptinessBetweenVoxelsAddsNothing) {
    for (const int far : {5000, 1'000'000, (1 << 30) - 2}) {
        test::VdbFixture two;
        two.boxes = {{{-far, -1, 4095}, {-far, -1, 4095}, 1},
                     {{far, -1, 4095}, {far, -1, 4095}, 3}};
        const NanoGrid apart = grid(two);
        // A tent of an area as large as the value, cut off axis.
        for (const double beside : {0.0, 0.25, -0.5}) {
            const LatticeLine line{{-far - 3.0, -1 + beside, 4095}, {2.0 * far + 6, 0, 0}};
            EXPECT_NEAR(apart.integrate(line) * (2.0 * far + 6), 4 * (1 - std::abs(beside)),
                        1e-6);  // rounding of coordinates of 1e9
        }
        EXPECT_EQ(apart.sample({0, 0, 0}), 0);
        EXPECT_EQ(apart.sample({double(far), -1, 4095}), 3);
    }
}

/// Between tiles of two values the interpolant is linear; along their faces it has one value.
TEST_F(NanoGridTest, LayersBetweenTilesAreInterpolated) {
    test::VdbFixture chequered;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            for (int k = 0; k < 3; ++k) {
                const std::array<int, 3> low{4096 * i, 4096 * j, 4096 * k};
                chequered.boxes.push_back(
                    {low, {low[0] + 4095, low[1] + 4095, low[2] + 4095}, 1.0 + (i + j + k) % 2});
            }
    const NanoGrid tiles = grid(chequered);
    EXPECT_EQ(tiles.sample({100, 4095.5, 100}), 1.5);
    EXPECT_EQ(tiles.sample({100, 4095.25, 5000}), 2 - 0.25);
    for (const double beside : {0.0, 0.25, 0.5})
        for (const auto& [from, to] : std::vector<std::pair<Point3, Point3>>{
                 {{0, 4095 + beside, 100}, {12287, 4095 + beside, 100}},
                 {{0, 4095 + beside, 4095.5}, {12287, 4095 + beside, 4095.5}},
                 {{10, 4000, 4095.5}, {12000, 4300, 4095.5}},
                 {{0, 0, 0}, {12287, 12287, 12287}}}) {
            const LatticeLine line{from, to - from};
            // By Gauss points between all planes that the line crosses.
            std::vector<double> knots{0, 1};
            for (int axis = 0; axis < 3; ++axis)
                for (int plane = 0; plane < 12288 && line.direction[axis] != 0; ++plane)
                    if (plane % 4096 == 0 || plane % 4096 == 4095) {
                        const double t = (plane - line.origin[axis]) / line.direction[axis];
                        if (t > 0 && t < 1) knots.push_back(t);
                    }
            std::ranges::sort(knots);
            double sum = 0;
            for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
                const double half = 0.5 * (knots[i + 1] - knots[i]), middle = knots[i] + half;
                for (const double side : {-1.0, 1.0})
                    sum +=
                        half * tiles.sample(line.origin + (middle + side * half / std::sqrt(3.0)) *
                                                              line.direction);
            }
            EXPECT_NEAR(tiles.integrate(line), sum, 1e-12);
        }
}

TEST_F(NanoGridTest, SupportIsOneVoxelAroundTheValues) {
    const NanoGrid one = grid(test::single_voxel("density", 2));
    EXPECT_EQ(one.support().min, (Point3{0, 0, 0}));
    EXPECT_EQ(one.support().max, (Point3{2, 2, 2}));
    EXPECT_EQ(one.sample({1, 1, 1}), 2);
    EXPECT_EQ(one.sample({1.25, 0.5, 1}), 2 * 0.75 * 0.5);
    EXPECT_EQ(one.sample({2, 1, 1}), 0);
    EXPECT_GT(one.bytes(), 0U);
    // A tent of height 2 over two voxels.
    EXPECT_NEAR(one.integrate({{-3, 1, 1}, {8, 0, 0}}), 2.0 / 8, 1e-15);
}

TEST(NanoGrid, StoredSumIsThatOfEveryVoxel) {
    double expected = 0, voxels = 0;
    for (int i = -9; i <= 10; ++i)
        for (int j = -3; j <= 14; ++j)
            for (int k = -6; k <= 15; ++k, ++voxels) expected += test::bumpy(i, j, k);
    test::FieldMaker maker;
    // Rounding of 16-bit values is far below half a quantum in the mean.
    const double tolerance = test::k_quantum * voxels;
    EXPECT_NEAR(stored_sum(*maker.field(test::bumpy_fixture())), expected, tolerance);
    // Cut into bricks, no voxel is counted twice or left out.
    const auto bricks =
        maker.field(test::bumpy_fixture(), Centering::node, UpAxis::y, std::size_t{4096});
    EXPECT_NEAR(stored_sum(*bricks), expected, tolerance);
}

}  // namespace
}  // namespace uw
