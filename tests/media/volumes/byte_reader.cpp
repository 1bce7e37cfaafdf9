// ctest labels: unit
#include "media/volumes/vdb_header.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/meshes/mesh_fixtures.h"
#include "tests/support/message_of.h"
#include "tests/support/scene_folder.h"

namespace uw {
namespace {

const SourceLocation k_volume_entry = "scene.yaml:3:5: volumes[0]";

std::string damage_of(const std::filesystem::path& file) {
    return k_volume_entry + ": '" + file.string() +
           "' is truncated or damaged; copy or export it again";
}

TEST(ByteReader, ReadsNumbersAndTextsAsTheyLie) {
    const test::SceneFolder folder;
    const auto file = folder.write("a.bin", std::string("\x01\x02\x03\x04\xff", 5) +
                                                test::bytes_of<double>({0.1}) +
                                                test::bytes_of<std::uint32_t>({5}) + "helloxyz");
    ByteReader in(file, k_volume_entry);
    EXPECT_EQ(in.size(), 25);
    EXPECT_EQ(in.get<std::uint32_t>(), 0x04030201U);
    EXPECT_EQ(in.get<std::int8_t>(), -1);
    EXPECT_EQ(in.get<double>(), 0.1);
    EXPECT_EQ(in.text(), "hello");
    EXPECT_EQ(in.text(3), "xyz");
    EXPECT_EQ(in.position(), 25);
    in.seek(1);
    in.skip(2);
    EXPECT_EQ(in.get<std::uint8_t>(), 4);
}

TEST(ByteReader, HopsThroughALargeFile) {
    // Larger than what is read at once, and visited forwards and backwards.
    std::vector<std::uint32_t> numbers(100000);
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<std::uint32_t>(i * i);
    const test::SceneFolder folder;
    const auto file = folder.write("a.bin", test::bytes_of(numbers));
    ByteReader in(file, k_volume_entry);
    for (std::size_t i = 0; i < numbers.size(); i += 777) {
        for (const std::size_t at : {i, numbers.size() - 1 - i}) {
            in.seek(static_cast<std::int64_t>(4 * at));
            ASSERT_EQ(in.get<std::uint32_t>(), numbers[at]);
        }
    }
    std::vector<std::uint32_t> all(numbers.size());
    in.seek(0);
    in.read(reinterpret_cast<char*>(all.data()), 4 * all.size());
    EXPECT_EQ(all, numbers);
}

TEST(ByteReader, NeverLeavesTheFile) {
    const test::SceneFolder folder;
    const auto file = folder.write("a.bin", "12345678");
    ByteReader in(file, k_volume_entry);
    in.seek(4);
    EXPECT_EQ(test::message_of<InputError>([&] { in.get<std::int64_t>(); }), damage_of(file));
    for (const std::int64_t position : {-1L, 9L, INT64_MAX, INT64_MIN}) {
        EXPECT_EQ(test::message_of<InputError>([&] { in.seek(position); }), damage_of(file));
    }
    for (const std::int64_t bytes : {-1L, 5L, INT64_MAX, INT64_MIN}) {
        EXPECT_EQ(test::message_of<InputError>([&] { in.skip(bytes); }), damage_of(file));
    }
    EXPECT_EQ(in.position(), 4);
    EXPECT_NO_THROW(in.skip(4));
}

TEST(ByteReader, BelievesNoAbsurdText) {
    const test::SceneFolder folder;
    const auto file =
        folder.write("a.bin", test::bytes_of<std::uint32_t>({4097}) + std::string(5000, 'x'));
    ByteReader in(file, k_volume_entry);
    EXPECT_NE(test::message_of<InputError>([&] { in.text(); }).find("absurdly long"),
              std::string::npos);
    in.seek(4);
    EXPECT_EQ(in.text(4096), std::string(4096, 'x'));
}

TEST(ByteReader, ThatCannotOpenSaysWhy) {
    const test::SceneFolder folder;
    const auto missing = folder.path() / "none.vdb";
    EXPECT_EQ(test::message_of<IoError>([&] { ByteReader(missing, k_volume_entry); }),
              k_volume_entry + ": '" + missing.string() +
                  "': no such file; check the name of the volume");
    EXPECT_EQ(
        test::message_of<IoError>([&] { ByteReader(folder.path(), k_volume_entry); }),
        k_volume_entry + ": '" + folder.path().string() + "': is a folder; name the volume in it");
}

}  // namespace
}  // namespace uw
