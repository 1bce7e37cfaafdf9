// ctest labels: unit metamorphic
#include "media/volumes/nvdb_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>

#include "core/base/error.h"
#include "media/volumes/vdb_file.h"
#include "media/volumes/vdb_header.h"
#include "tests/support/message_of.h"
#include "tests/support/temp_dir.h"
#include "tests/support/vdb/vdb_loading.h"

namespace uw {
namespace {

test::VdbFixture wavy_grid() {
    test::VdbFixture fixture = test::single_voxel("density");
    fixture.max = {20, 12, 9};
    fixture.value = [](int i, int j, int k) { return 2 + std::sin(0.3 * i + 0.7 * j - 0.2 * k); };
    return fixture;
}

NvdbBytes only_grid_of(const std::filesystem::path& file) {
    const VdbHeader header = read_vdb_header(file, test::k_where);
    return read_nvdb_bytes(header, header.grids.at(0), test::k_where);
}

TEST(NvdbBytes, AreTheSamePackedAndUnpacked) {
    const test::TempDir dir;
    test::write_nvdb_fixture(dir / "plain.nvdb", wavy_grid(), "float", 0);
    const NvdbBytes plain = only_grid_of(dir / "plain.nvdb");
    ASSERT_GT(plain.size, 1000U);
    EXPECT_EQ(std::memcmp(plain.data.get(), "NanoVDB", 7), 0);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(plain.data.get()) % 32, 0U);  // as nodes have to be
    for (const int codec : {1, 2}) {
        test::write_nvdb_fixture(dir / "packed.nvdb", wavy_grid(), "float", codec);
        EXPECT_LT(std::filesystem::file_size(dir / "packed.nvdb"),
                  std::filesystem::file_size(dir / "plain.nvdb"));
        const NvdbBytes unpacked = only_grid_of(dir / "packed.nvdb");
        EXPECT_EQ(reinterpret_cast<std::uintptr_t>(unpacked.data.get()) % 32, 0U);
        ASSERT_EQ(unpacked.size, plain.size);
        EXPECT_EQ(std::memcmp(unpacked.data.get(), plain.data.get(), plain.size), 0);
    }
}

TEST(NvdbBytes, BelieveNoForgedLengths) {
    const test::TempDir dir;
    for (const int codec : {0, 1, 2}) {
        test::write_nvdb_fixture(dir / "a.nvdb", wavy_grid(), "float", codec);
        const VdbHeader header = read_vdb_header(dir / "a.nvdb", test::k_where);
        std::string bytes = test::file_bytes(dir / "a.nvdb");
        // What begins the grid: its magic number, or the length of what is packed.
        bytes[static_cast<std::size_t>(header.grids[0].blocks_offset) + 6] = '\x7f';
        test::write_file_bytes(dir / "forged.nvdb", bytes);
        test::expect_contains(test::refusal(dir / "forged.nvdb", "density"),
                              "truncated or damaged");
    }
}

TEST(NvdbBytes, OfMoreThanTheMemoryAreNotTried) {
    const test::TempDir dir;
    test::write_nvdb_fixture(dir / "a.nvdb", wavy_grid(), "float", 1);
    VdbHeader header = read_vdb_header(dir / "a.nvdb", test::k_where);
    const auto refusal_of_bytes = [&](std::int64_t bytes) {
        header.grids[0].grid_bytes = bytes;
        return test::message_of<InputError>([&] { load_grid(header, "density", test::k_where); });
    };
    test::expect_contains(refusal_of_bytes(INT64_MAX), "needs 9.22e+09 GB of memory, but only");
    // Less than a grid begins with.
    test::expect_contains(refusal_of_bytes(10), "truncated or damaged");
}

}  // namespace
}  // namespace uw
