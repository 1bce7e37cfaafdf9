// ctest labels: analytic
#include "media/volumes/vdb_file.h"

//
// A plume that moves while the shutter is open is its average over that time: of one velocity all
// over, the box-filtered plume, in closed form.
#include <gtest/gtest.h>

#include <cmath>

#include "media/volumes/load_volumes.h"
#include "tests/support/temp_dir.h"
#include "tests/support/vdb/vdb_loading.h"

namespace uw {
namespace {

using test::TempDir;
using test::VdbFixture;
using test::VelocityKind;

constexpr double k_voxel = 0.05;    // m
constexpr double k_sigma = 4;       // voxels
constexpr double k_shutter = 0.04;  // s
constexpr int k_reach = 20;         // of the blob [voxels]: e^-12.5 is left out

/// A Gaussian ball of peak 1 around the index origin.
VdbFixture ball() {
    VdbFixture fixture;
    fixture.min = {-k_reach, -k_reach, -k_reach};
    fixture.max = {k_reach, k_reach, k_reach};
    fixture.value = [](int i, int j, int k) {
        return std::exp(-(i * i + j * j + k * k) / (2 * k_sigma * k_sigma));
    };
    fixture.file_from_index = Affine::scale(Vector3(k_voxel));
    return fixture;
}

/// Its average along x over a way of `length` voxels, at (x, y, z) [voxels].
double smeared(double x, double y, double z, double length) {
    const double root = std::sqrt(2.0) * k_sigma;
    const double along = std::sqrt(std::acos(-1.0) / 2) * k_sigma / length *
                         (std::erf((x + length / 2) / root) - std::erf((x - length / 2) / root));
    return along * std::exp(-(y * y + z * z) / (2 * k_sigma * k_sigma));
}

VolumeDesc moving(const std::filesystem::path& file, VelocityKind kind, double shutter) {
    VolumeDesc desc;
    desc.file = file;
    desc.where = test::k_where;
    desc.grids.resize(1);
    desc.grids[0].grid = "density";
    desc.grids[0].where = desc.where;
    MotionDesc motion;
    motion.file = file;
    motion.where = desc.where + ".velocity";
    motion.shutter = shutter;
    motion.grids = {"vel"};
    if (kind == VelocityKind::three_numbers) motion.grids = {"vel.x", "vel.y", "vel.z"};
    desc.motion = motion;
    return desc;
}

GridVolume load(const VolumeDesc& desc) {
    return load_volume(desc, {{GridLoad{0, 1.0}}}).grids.at(0);
}

class MovingGrid : public testing::TestWithParam<VelocityKind> {
  protected:
    TempDir dir_;
};

TEST_P(MovingGrid, IsTheAverageOverTheShuttersTime) {
    const double length = 11.3;  // voxels
    const Vector3 velocity(length * k_voxel / k_shutter, 0, 0);
    test::write_moving_grid(dir_ / "a.vdb", ball(), velocity, GetParam());
    const GridVolume volume = load(moving(dir_ / "a.vdb", GetParam(), k_shutter));
    const GridVolume still = load(moving(dir_ / "a.vdb", GetParam(), 0));
    // Interpolation between voxels flattens the peak by up to h^2/8 |f''| = 1/(8 sigma^2) = 0.8 %.
    constexpr double tolerance = 0.008;
    for (int i = -26; i <= 26; ++i)
        for (int j = -8; j <= 8; j += 4) {
            const Point3 x{i * k_voxel, j * k_voxel, 2 * k_voxel};
            EXPECT_NEAR(volume.value(x), smeared(i, j, 2, length), tolerance) << i << " " << j;
        }
    // The middle is clearly less than the still peak, so the average was taken at all.
    EXPECT_LT(volume.value({0, 0, 0}), 0.8 * still.value({0, 0, 0}));
    // Nothing is lost: the column along the way is the same, to the values' 16 bits.
    for (int j = -8; j <= 8; j += 4) {
        const Point3 a{-3, j * k_voxel, 0}, b{3, j * k_voxel, 0};
        EXPECT_NEAR(volume.column(a, b), still.column(a, b), 1e-3 * still.column(a, b));
    }
}

TEST_P(MovingGrid, StandsStillWithoutVelocity) {
    test::write_moving_grid(dir_ / "a.vdb", ball(), Vector3(0.0), GetParam());
    const GridVolume moved = load(moving(dir_ / "a.vdb", GetParam(), k_shutter));
    const GridVolume still = load(moving(dir_ / "a.vdb", GetParam(), 0));
    for (int i = -22; i <= 22; ++i)
        EXPECT_NEAR(moved.value({i * 0.7 * k_voxel, 0.02, 0.01}),
                    still.value({i * 0.7 * k_voxel, 0.02, 0.01}), 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Motion, MovingGrid,
                         testing::Values(VelocityKind::vectors, VelocityKind::staggered,
                                         VelocityKind::three_numbers));

TEST(MovingGridScale, IsTwoAndAHalfVoxelsASecondInBlendersCaches) {
    const TempDir dir;
    VdbFixture density = ball();
    density.blender_metadata = true;
    const double length = 8;  // voxels
    test::write_moving_grid(dir / "a.vdb", density, Vector3(length / k_shutter / 2.5, 0, 0),
                            VelocityKind::staggered);
    const GridVolume volume = load(moving(dir / "a.vdb", VelocityKind::staggered, k_shutter));
    // Cells, and z up: the middle of cell (0, 0, 0) is half a voxel from the corner.
    const Point3 middle{k_voxel / 2, k_voxel / 2, -k_voxel / 2};
    EXPECT_NEAR(volume.value(middle), smeared(0, 0, 0, length), 0.008);
    VolumeDesc desc = moving(dir / "a.vdb", VelocityKind::staggered, k_shutter);
    desc.motion->scale = 0.0;
    EXPECT_NEAR(load(desc).value(middle), 1, 1e-3);
}

TEST(MovingGridErrors, AreToldByName) {
    const TempDir dir;
    test::write_moving_grid(dir / "a.vdb", ball(), Vector3(1000, 0, 0), VelocityKind::vectors);
    const auto refusal = [&](const VolumeDesc& desc) {
        try {
            load(desc);
        } catch (const InputError& error) {
            return std::string(error.what());
        }
        return std::string("not refused");
    };
    VolumeDesc desc = moving(dir / "a.vdb", VelocityKind::vectors, k_shutter);
    test::expect_contains(refusal(desc), "check velocity.scale");
    desc.motion->grids = {"velo"};
    test::expect_contains(refusal(desc), "no grid 'velo'");
    desc.motion->grids = {"density"};
    test::expect_contains(refusal(desc), "velocity is one grid of vectors");
}

}  // namespace
}  // namespace uw
