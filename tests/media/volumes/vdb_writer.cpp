// ctest labels: unit
#include "media/volumes/vdb_writer.h"

#include <gtest/gtest.h>

#include <atomic>
#include <fstream>

#include "core/base/error.h"
#include "media/volumes/vdb_file.h"
#include "media/volumes/vdb_header.h"
#include "tests/support/faults/stop_at_size.h"
#include "tests/support/full_disk.h"
#include "tests/support/temp_dir.h"

namespace uw {
namespace {

using test::TempDir;

TEST(VdbWriter, WritesWhatItIsGiven) {
    const TempDir dir;
    VdbOutputGrid out;
    out.name = "lamp.540nm";
    out.size = {11, 9, 5};
    out.voxel_size = 0.5;
    out.origin = {1, 2, 3};
    out.value = [](int i, int j, int k) { return static_cast<float>(i == j ? 0 : i + j + k); };
    out.metadata = {{"unit", "W/m^2"}};
    write_vdb(dir / "out.vdb", {out}, {{"creator", "uwvdb"}});
    const VdbHeader header = read_vdb_header(dir / "out.vdb", "here");
    EXPECT_EQ(header.creator, "uwvdb");
    EXPECT_EQ(header.grids.at(0).active_voxels, 11 * 9 * 5 - 9 * 5);
    const LoadedGrid grid = load_grid(header, "lamp.540nm", "here");
    EXPECT_EQ(grid.file_from_index * Point3(2, 0, 0), Point3(2, 2, 3));
    EXPECT_NEAR(grid.bricks.at(0).sample({10, 8, 4}), 22, 22.0 / 65535);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(dir.path()), {}), 1);
}

TEST(VdbWriter, LeavesNothingBehindWhenItCannotWrite) {
    const TempDir dir;
    VdbOutputGrid out;
    out.size = {1, 1, 1};
    out.value = [](int, int, int) { return 1.0F; };
    std::filesystem::create_directory(dir / "taken");
    std::ofstream(dir / "taken/file") << "x";
    EXPECT_THROW(write_vdb(dir / "taken", {out}, {}), IoError);
    EXPECT_THROW(write_vdb(dir / "taken/file/smoke.vdb", {out}, {}), IoError);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(dir.path()), {}), 1);
}

TEST(VdbWriter, AFullDiskLeavesTheOldFile) {
    const TempDir dir;
    VdbOutputGrid out;
    out.name = "noise";
    out.size = {32, 32, 32};
    out.value = [](int i, int j, int k) {
        return static_cast<float>(i * 7919 + j * 104729 + k * 1299709 % 1009) + 0.1F;
    };
    write_vdb(dir / "whole.vdb", {out}, {});
    const auto size = static_cast<rlim_t>(std::filesystem::file_size(dir / "whole.vdb"));
    std::ofstream(dir / "out.vdb") << "old";
    for (const rlim_t room : {rlim_t{0}, rlim_t{100}, size / 2, size - 100, size - 1})
        EXPECT_THROW(test::limited(room, [&] { write_vdb(dir / "out.vdb", {out}, {}); }), IoError)
            << room << " of " << size;
    EXPECT_EQ(std::filesystem::file_size(dir / "out.vdb"), 3U);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(dir.path()), {}), 2);
}

TEST(VdbWriter, StopsWithinABlock) {
    const TempDir dir;
    VdbOutputGrid noise;
    noise.name = "noise";
    noise.size = {64, 64, 64};  // 1 MB
    noise.value = [](int i, int j, int k) {
        return static_cast<float>((i * 7919 + j * 104729 + k * 1299709) % 1009) + 0.1F;
    };
    OutputFile out(dir / "out.vdb");
    constexpr std::uint64_t k_until = 100'000, k_block = 512 * sizeof(float);
    // What streams hold back.
    constexpr std::uint64_t k_buffers = 64 << 10;
    const auto write = [&] { write_vdb(out, {noise}, {}); };
    EXPECT_THROW(test::stopped_at_size(k_until, write), Interrupted);
    EXPECT_GE(out.position(), k_until);
    EXPECT_LE(out.position(), k_until + k_block + k_buffers);
    OutputFile next(dir / "next.vdb");
    const std::atomic<bool> stop = true;
    const StopScope scope(stop);
    EXPECT_THROW(write_vdb(next, {noise}, {}), Interrupted);
    EXPECT_EQ(next.position(), 0U);
}

}  // namespace
}  // namespace uw
