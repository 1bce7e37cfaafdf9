// ctest labels: unit
#include "media/vdb/vdb_layout.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>

#include "core/base/error.h"
#include "tests/support/temp_dir.h"
#include "tests/support/vdb/vdb_loading.h"

namespace uw {
namespace {

using test::expect_contains;
using test::file_bytes;
using test::load;
using test::refusal;
using test::single_voxel;
using test::TempDir;
using test::VdbFixture;
using test::write_file_bytes;

TEST(VdbLayout, EveryTruncationIsRefused) {
    const TempDir dir;
    VdbFixture fixture = single_voxel("density");
    fixture.max = {12, 12, 12};
    fixture.value = [](int i, int j, int k) { return 0.1 * i + 0.7 * j + std::sin(k); };
    test::write_fixture(dir / "a.vdb", {fixture});
    const std::string bytes = file_bytes(dir / "a.vdb");
    for (std::size_t size = 9; size < bytes.size(); size += 97) {
        write_file_bytes(dir / "cut.vdb", bytes.substr(0, size));
        expect_contains(refusal(dir / "cut.vdb", "density"), "truncated or damaged");
    }
}

TEST(VdbLayout, ForgedBlocksAreRefusedBeforeTheyAreRead) {
    const TempDir dir;
    VdbFixture fixture = single_voxel("density");
    fixture.max = {20, 20, 20};
    fixture.value = [](int i, int j, int k) { return 2 + std::sin(i * 12.9 + j * 78.2 + k * 3.7); };
    test::write_fixture(dir / "a.vdb", {fixture});
    const std::string bytes = file_bytes(dir / "a.vdb");
    // "Stored uncompressed, 100000 bytes" wherever it falls; some are blocks of 512 values.
    const std::int64_t forged_size = -100000;
    int refused = 0;
    for (std::size_t at = 700; at + 8 < bytes.size(); at += 101) {
        std::string forged = bytes;
        std::memcpy(&forged[at], &forged_size, sizeof forged_size);
        write_file_bytes(dir / "forged.vdb", forged);
        try {
            load(dir / "forged.vdb", "density");
        } catch (const InputError&) {
            ++refused;
        }
    }
    EXPECT_GT(refused, 0);
}

}  // namespace
}  // namespace uw
