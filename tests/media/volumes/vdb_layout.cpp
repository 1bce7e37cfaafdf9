// ctest labels: unit
#include "media/volumes/vdb_stream.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "core/base/error.h"
#include "media/inspection/vdb_inspect.h"
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

// OpenVDB reads the byte that says whether a tile of the root is active into a bool as it is.
TEST(VdbLayout, RootTilesAreActiveOrNot) {
    const TempDir dir;
    const float value = 0.37F;
    VdbFixture fixture = single_voxel("density");
    fixture.boxes = {{{4096, 0, 0}, {8191, 4095, 4095}, value}};
    test::write_fixture(dir / "a.vdb", {fixture});
    std::string bytes = file_bytes(dir / "a.vdb");
    std::string tile(sizeof value, '\0');
    std::memcpy(tile.data(), &value, sizeof value);
    const std::size_t at = bytes.find(tile + '\x01');
    ASSERT_NE(at, std::string::npos);
    EXPECT_NO_THROW(inspect_vdb(dir / "a.vdb", test::k_where));
    for (const char active : {'\x02', '\x39', '\xff'}) {
        bytes[at + sizeof value] = active;
        write_file_bytes(dir / "forged.vdb", bytes);
        expect_contains(refusal(dir / "forged.vdb", "density"), "truncated or damaged");
    }
}

// What OpenVDB says of a map that it does not know quotes the file.
TEST(VdbLayout, MapsWithUnprintableNamesAreRefusedInOneLine) {
    const TempDir dir;
    test::write_fixture(dir / "a.vdb", {single_voxel("density")});
    std::string bytes = file_bytes(dir / "a.vdb");
    const std::size_t at = bytes.find("ScaleMap");
    ASSERT_NE(at, std::string::npos);
    for (const char character : {'\n', '\x1b', '\0'}) {
        bytes[at] = character;
        write_file_bytes(dir / "forged.vdb", bytes);
        expect_contains(refusal(dir / "forged.vdb", "density"), "cannot be read");
    }
}

// A frustum states a second map by its name, before OpenVDB 10 looks whether the file holds one so
// long, and calls itself where that is a frustum again.
class VdbFrustum : public testing::Test {
  protected:
    VdbFrustum() {
        test::write_frustum_grid(dir_ / "a.vdb");
        bytes_ = file_bytes(dir_ / "a.vdb");
        begin_ = bytes_.find(k_name) + k_name.size();
        second_ = begin_ + 8 * sizeof(double);  // after its box, taper and depth
    }
    /// What is said about the file with these bytes in place of those from `second_` on.
    std::string refusal_of(const std::string& bytes) const {
        std::string forged = bytes_;
        forged.replace(second_, bytes.size(), bytes);
        write_file_bytes(dir_ / "forged.vdb", forged);
        try {
            inspect_vdb(dir_ / "forged.vdb", test::k_where);
        } catch (const InputError& error) {
            return error.what();
        }
        return "";
    }

    static constexpr std::string_view k_name = "NonlinearFrustumMap";
    TempDir dir_;
    std::string bytes_;
    std::size_t begin_ = 0, second_ = 0;
};

TEST_F(VdbFrustum, OfAHugeNameIsRefusedBeforeItIsRead) {
    expect_contains(refusal_of("\xff\xff\xff\xff"), "absurdly long name");
}

TEST_F(VdbFrustum, WithinAFrustumIsRefused) {
    const std::string length(1, static_cast<char>(k_name.size()));
    const std::string level = length + std::string(3, '\0') + std::string(k_name) +
                              bytes_.substr(begin_, second_ - begin_);
    std::string levels;
    for (int n = 0; n < 100'000; ++n) levels += level;  // more than a stack holds
    // The grid ends after them.
    for (const std::string_view end : {level, levels})
        expect_contains(refusal_of(std::string(end)), "truncated or damaged");
}

}  // namespace
}  // namespace uw
