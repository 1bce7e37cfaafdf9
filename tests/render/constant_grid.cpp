// ctest labels: metamorphic
// A grid of constant value is the same water as particles given as a number, however the grid is
// cut, scaled, turned or mirrored (physics section 1).
#include <gtest/gtest.h>

#include "tests/support/temp_dir.h"
#include "tests/support/test_scene.h"
#include "tests/support/vdb/vdb_fixtures.h"

namespace uw::test {
namespace {

// The bound of every comparison, relative and per pixel. The two sides differ in where the panels
// lie and in the 16-bit grid, both below 1e-4.
constexpr double k_tolerance = 1e-3;
constexpr double k_small_ppm = 0.05;
constexpr double k_large_ppm = 0.4;
constexpr double k_reach = 8;  // the grid spans [-8, 8] m: all of the scene

SceneDesc scene_without_particles() {
    SceneDesc desc = pinhole_scene(16, 12);
    desc.geometry = {plane_at_z(4), box({0.1, -0.2, 1.0}, {0.4, 0.1, 1.3})};
    desc.lamps = {isotropic_lamp({1, -0.5, 0}, 50)};
    desc.water.scattering.reset();
    desc.water.small_ppm = 0;
    desc.water.large_ppm = 0;
    return desc;
}

// Writes a grid of ones over [x_min, x_max] x [-reach, reach]^2 before `transform`, with voxels of
// `voxel` metres. Values sit half a voxel inside the bounds, so that two halves make a whole.
std::filesystem::path write_ones(const TempDir& dir, double voxel, const Affine& transform = {},
                                 double x_min = -k_reach, double x_max = k_reach) {
    VdbFixture grid;
    const auto count = [&](double length) { return static_cast<int>(std::lround(length / voxel)); };
    grid.boxes = {{{0, 0, 0},
                   {count(x_max - x_min) - 1, count(2 * k_reach) - 1, count(2 * k_reach) - 1},
                   1.0}};
    const Vector3 first(x_min + 0.5 * voxel, -k_reach + 0.5 * voxel, -k_reach + 0.5 * voxel);
    grid.file_from_index = transform * Affine::translation(first) * Affine::scale(Vector3(voxel));
    const std::filesystem::path file = dir / ("ones" + std::to_string(x_min) + ".vdb");
    write_fixture(file, {grid});
    return file;
}

VolumeDesc volume(const std::filesystem::path& file) {
    VolumeDesc desc;
    desc.file = file;
    desc.where = "test";
    GridMappingDesc mapping;
    mapping.grid = "density";
    mapping.small_ppm = k_small_ppm;
    mapping.large_ppm = k_large_ppm;
    mapping.where = "test";
    desc.grids = {mapping};
    return desc;
}

void expect_same_image(const SceneDesc& a, const SceneDesc& b) {
    const TestScene first(a), second(b);
    double worst = 0;
    for (int y = 0; y < a.camera.height; ++y) {
        for (int x = 0; x < a.camera.width; ++x) {
            const PixelResult p = first.pixel(x, y), q = second.pixel(x, y);
            for (std::size_t band = 0; band < 3; ++band) {
                ASSERT_GT(p.backscatter[band], 0);
                worst = std::max(worst, std::abs(q.backscatter[band] / p.backscatter[band] - 1));
                if (p.direct[band] > 0)
                    worst = std::max(worst, std::abs(q.direct[band] / p.direct[band] - 1));
                else
                    EXPECT_EQ(q.direct[band], 0);
            }
        }
    }
    EXPECT_LT(worst, k_tolerance);
    std::cout << "worst relative difference " << worst << "\n";
}

class ConstantGrid : public ::testing::Test {
  protected:
    static SceneDesc homogeneous() {
        SceneDesc desc = scene_without_particles();
        desc.water.small_ppm = k_small_ppm;
        desc.water.large_ppm = k_large_ppm;
        return desc;
    }
    SceneDesc with(const std::vector<VolumeDesc>& volumes) const {
        SceneDesc desc = scene_without_particles();
        desc.volumes = volumes;
        return desc;
    }
    TempDir dir_;
};

TEST_F(ConstantGrid, IsHomogeneousWater) {
    expect_same_image(homogeneous(), with({volume(write_ones(dir_, 0.25))}));
}

TEST_F(ConstantGrid, MayBeCutInTwo) {
    expect_same_image(homogeneous(), with({volume(write_ones(dir_, 0.25, {}, -k_reach, 0.5)),
                                           volume(write_ones(dir_, 0.25, {}, 0.5, k_reach))}));
}

TEST_F(ConstantGrid, MayHaveVoxelsOfTwiceTheSize) {
    expect_same_image(homogeneous(), with({volume(write_ones(dir_, 0.5))}));
}

TEST_F(ConstantGrid, MayBeTurned) {
    const Affine turned = Affine::rotation_xyz_degrees({20, 35, -15});
    expect_same_image(homogeneous(), with({volume(write_ones(dir_, 0.25, turned))}));
}

TEST_F(ConstantGrid, MayHaveANegativeScale) {
    expect_same_image(homogeneous(),
                      with({volume(write_ones(dir_, 0.25, Affine::scale({-1, 1, -1})))}));
}

TEST_F(ConstantGrid, MayBeShearedAndStretchedBecauseConcentrationsAreMetric) {
    const Affine sheared({1.5, 0.2, 0, 0, 2, 0.3, 0.1, 0, 1.25}, Vector3(0.0));
    expect_same_image(homogeneous(), with({volume(write_ones(dir_, 0.25, sheared))}));
}

TEST_F(ConstantGrid, OfNearlyZeroIsPureWaterNotVacuum) {
    SceneDesc zero = with({volume(write_ones(dir_, 0.5))});
    zero.volumes[0].grids[0].small_ppm = 0;
    zero.volumes[0].grids[0].large_ppm = 1e-12;
    expect_same_image(scene_without_particles(), zero);
}

}  // namespace
}  // namespace uw::test
