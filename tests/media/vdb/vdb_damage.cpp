// ctest labels: unit
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>

#include "core/base/error.h"
#include "tests/support/temp_dir.h"
#include "tests/support/vdb/vdb_loading.h"

namespace uw {
namespace {

using test::expect_contains;
using test::k_where;
using test::load;
using test::refusal;
using test::single_voxel;
using test::TempDir;
using test::VdbFixture;

std::string read_bytes(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

void write_bytes(const std::filesystem::path& file, const std::string& bytes) {
    std::ofstream(file, std::ios::binary) << bytes;
}

TEST(VdbDamage, RefusesWhatIsNoVdb) {
    const TempDir dir;
    EXPECT_THROW(read_vdb_header(dir / "none.vdb", k_where), IoError);
    EXPECT_THROW(read_vdb_header(dir.path(), k_where), IoError);
    write_bytes(dir / "text.vdb", "this is a text, not a volume");
    expect_contains(refusal(dir / "text.vdb", "density"), "is not a VDB file");
    write_bytes(dir / "empty.vdb", "");
    expect_contains(refusal(dir / "empty.vdb", "density"), "is not a VDB file");
}

TEST(VdbDamage, NamesTheVersionOfAFileThatIsTooNew) {
    const TempDir dir;
    test::write_fixture(dir / "a.vdb", {single_voxel("density")});
    std::string bytes = read_bytes(dir / "a.vdb");
    bytes[8] = static_cast<char>(225);  // the format's version follows 8 bytes of magic number
    bytes[12] = 13;
    write_bytes(dir / "new.vdb", bytes);
    const std::string message = refusal(dir / "new.vdb", "density");
    expect_contains(message, "version 225, written by OpenVDB 13.");
    expect_contains(message, "up to version 224");
}

TEST(VdbDamage, EveryTruncationIsRefused) {
    const TempDir dir;
    VdbFixture fixture = single_voxel("density");
    fixture.max = {12, 12, 12};
    fixture.value = [](int i, int j, int k) { return 0.1 * i + 0.7 * j + std::sin(k); };
    test::write_fixture(dir / "a.vdb", {fixture});
    const std::string bytes = read_bytes(dir / "a.vdb");
    for (std::size_t size = 9; size < bytes.size(); size += 97) {
        write_bytes(dir / "cut.vdb", bytes.substr(0, size));
        expect_contains(refusal(dir / "cut.vdb", "density"), "cut short or damaged");
    }
}

TEST(VdbDamage, ForgedSizesAreNotBelieved) {
    const TempDir dir;
    test::write_fixture(dir / "a.vdb", {single_voxel("density")});
    const std::string bytes = read_bytes(dir / "a.vdb");
    // Words all over the header and metadata claim in turn to be 4 GB.
    for (std::size_t at = 21; at < std::min<std::size_t>(bytes.size() - 4, 700); at += 3) {
        std::string forged = bytes;
        for (std::size_t i = 0; i < 4; ++i) forged[at + i] = static_cast<char>(0xfe);
        write_bytes(dir / "forged.vdb", forged);
        try {
            load(dir / "forged.vdb", "density");  // a word that is no size may well load
        } catch (const InputError&) {
        }
    }
}

TEST(VdbDamage, ForgedBlocksAreRefusedBeforeTheyAreRead) {
    const TempDir dir;
    VdbFixture fixture = single_voxel("density");
    fixture.max = {20, 20, 20};
    fixture.value = [](int i, int j, int k) { return 2 + std::sin(i * 12.9 + j * 78.2 + k * 3.7); };
    test::write_fixture(dir / "a.vdb", {fixture});
    const std::string bytes = read_bytes(dir / "a.vdb");
    // "Stored uncompressed, 100000 bytes" wherever it falls; some are blocks of 512 values.
    const std::int64_t forged_size = -100000;
    int refused = 0;
    for (std::size_t at = 700; at + 8 < bytes.size(); at += 101) {
        std::string forged = bytes;
        std::memcpy(&forged[at], &forged_size, sizeof forged_size);
        write_bytes(dir / "forged.vdb", forged);
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
