// ctest labels: unit
#include "media/volumes/vdb_header.h"

#include <gtest/gtest.h>

#include <cstring>

#include "core/base/error.h"
#include "tests/support/message_of.h"
#include "tests/support/temp_dir.h"
#include "tests/support/vdb/vdb_loading.h"

namespace uw {
namespace {

class NvdbHeader : public testing::Test {
  protected:
    /// The bytes of a file with one grid called `name`.
    std::string bytes_with(const std::string& name, const std::string& precision = "float") const {
        test::write_nvdb_fixture(dir_ / "one.nvdb", test::single_voxel(name), precision);
        return test::file_bytes(dir_ / "one.nvdb");
    }
    VdbHeader header_of(const std::string& bytes) const {
        test::write_file_bytes(dir_ / "a.nvdb", bytes);
        return read_vdb_header(dir_ / "a.nvdb", test::k_where);
    }
    void expect_refused(const std::string& bytes, const std::string& what) const {
        const std::string message = test::message_of<InputError>([&] { header_of(bytes); });
        EXPECT_TRUE(message.starts_with(test::k_where)) << message;
        EXPECT_NE(message.find(what), std::string::npos) << message;
    }
    test::TempDir dir_;
};

TEST_F(NvdbHeader, IsToldByItsFirstBytes) {
    const std::string rest = bytes_with("density").substr(8);
    for (const char* magic : {"NanoVDB0", "NanoVDB2"})
        EXPECT_TRUE(header_of(magic + rest).is_nano) << magic;
    expect_refused("NanoVDB1" + rest, "holds a bare NanoVDB grid");
    const std::string with_bytes_swapped("\0\0\0\0VDB ", 8);
    for (const std::string& magic :
         {std::string("NanoVDB3"), std::string("nanoVDB0"), with_bytes_swapped})
        expect_refused(magic + rest, "is not a VDB file");
    // So begins a VDB file, whose version then follows.
    expect_refused(std::string(" BDV\0\0\0\0", 8) + rest, "is a VDB file of version ");
}

TEST_F(NvdbHeader, SaysWhatTheGridIs) {
    const VdbHeader header = header_of(bytes_with("density", "fp8"));
    EXPECT_TRUE(header.is_nano);
    EXPECT_EQ(header.library_major, 32U);
    ASSERT_EQ(header.grids.size(), 1U);
    const GridSummary& grid = header.grids[0];
    EXPECT_EQ(grid.name, "density");
    EXPECT_EQ(grid.value_type, "float");
    EXPECT_EQ(grid.quantised, "fp8");
    EXPECT_EQ(grid.grid_class, "fog volume");
    EXPECT_EQ(grid.active_voxels, 1);
    ASSERT_TRUE(grid.active_box);
    EXPECT_EQ(grid.active_box->min, (std::array<std::int32_t, 3>{1, 1, 1}));
    EXPECT_EQ(grid.active_box->max, (std::array<std::int32_t, 3>{1, 1, 1}));
    EXPECT_EQ(grid.stored_bytes, grid.grid_bytes);  // packed by no codec
}

TEST_F(NvdbHeader, FilesMayFollowOneAnother) {
    // Segments behind one another are one file, and namesakes in it get numbers.
    const VdbHeader header =
        header_of(bytes_with("density") + bytes_with("heat") + bytes_with("density"));
    ASSERT_EQ(header.grids.size(), 3U);
    EXPECT_EQ(header.grids[0].name, "density[0]");
    EXPECT_EQ(header.grids[1].name, "heat");
    EXPECT_EQ(header.grids[2].name, "density[1]");
    EXPECT_LT(header.grids[0].blocks_offset, header.grids[1].blocks_offset);
}

TEST_F(NvdbHeader, RefusesWhatItCannotRead) {
    const std::string bytes = bytes_with("density");
    for (std::size_t size = 9; size < bytes.size(); size += 61)
        expect_refused(bytes.substr(0, size), "truncated or damaged");
    expect_refused(bytes + "NanoVDBx", "truncated or damaged");
    std::string other = bytes;
    const std::uint32_t version = 31U << 21U | 5U << 10U;
    std::memcpy(&other[8], &version, sizeof version);
    expect_refused(other, "is a NanoVDB file of version 31.5; this build reads version 32");
    std::string codec = bytes;
    codec[14] = 3;
    expect_refused(codec, "truncated or damaged");
}

}  // namespace
}  // namespace uw
