// ctest labels: unit
#include "core/base/input_files.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>
#include <string>
#include <thread>

#include "core/base/error.h"
#include "tests/support/temp_dir.h"

namespace uw {
namespace {

constexpr std::size_t k_limit = std::size_t{1} << 20;

std::string text_file_failure(const std::filesystem::path& file) {
    try {
        read_text_file(file, "scene.yaml: lamps[0].file", k_limit, "IES file");
    } catch (const IoError& error) {
        return std::string("IoError ") + error.what();
    } catch (const InputError& error) {
        return std::string("InputError ") + error.what();
    }
    return "read";
}

TEST(TextFile, ReadsEveryByte) {
    const test::TempDir folder;
    const std::string text("a\r\nb\0c\n\xff", 8);
    std::ofstream(folder / "a.txt", std::ios::binary) << text;
    EXPECT_EQ(read_text_file(folder / "a.txt", "a.txt", k_limit, "text"), text);
    std::ofstream(folder / "empty.txt", std::ios::binary) << "";
    EXPECT_EQ(read_text_file(folder / "empty.txt", "empty.txt", k_limit, "text"), "");
}

TEST(TextFile, MayBeAsLargeAsTheLimitAndNoLarger) {
    const test::TempDir folder;
    std::ofstream(folder / "full.txt", std::ios::binary) << std::string(k_limit, 'x');
    EXPECT_EQ(read_text_file(folder / "full.txt", "full.txt", k_limit, "text").size(), k_limit);
    std::ofstream(folder / "over.txt", std::ios::binary) << std::string(k_limit + 1, 'x');
    EXPECT_EQ(
        text_file_failure(folder / "over.txt"),
        "InputError scene.yaml: lamps[0].file: is larger than 1 MiB; this is not a valid IES file");
}

TEST(TextFile, SaysWhatIsWrong) {
    const test::TempDir folder;
    EXPECT_EQ(text_file_failure(folder / "none.txt"),
              "IoError scene.yaml: lamps[0].file: no such file; check the name of the IES file");
    EXPECT_EQ(text_file_failure(folder.path()),
              "IoError scene.yaml: lamps[0].file: is a folder; name the IES file in it");
}

// Without an end, such as /dev/zero.
TEST(TextFile, IsNoDevice) {
    EXPECT_EQ(text_file_failure("/dev/zero"),
              "IoError scene.yaml: lamps[0].file: is a device; name the IES file");
}

TEST(TextFile, IsWhatAPipeBringsWhereItMay) {
    const test::TempDir folder;
    ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
    EXPECT_EQ(text_file_failure(folder / "pipe"),
              "IoError scene.yaml: lamps[0].file: is a pipe; name the IES file");
    // Nobody writes, and nobody waits.
    EXPECT_EQ(read_text_file(folder / "pipe", "pipe", k_limit, "text", Pipes::read), "");
    int ends[2];
    ASSERT_EQ(::pipe(ends), 0);
    const std::string text(k_limit, 'x');  // more than a pipe holds
    std::thread writer([&] {
        for (std::size_t at = 0; at < text.size(); at += 4096)
            if (::write(ends[1], &text[at], 4096) != 4096) break;
        ::close(ends[1]);
    });
    EXPECT_EQ(
        read_text_file("/dev/fd/" + std::to_string(ends[0]), "pipe", k_limit, "text", Pipes::read),
        text);
    writer.join();
    ::close(ends[0]);
}

TEST(OwnFile, IsNeitherAPipeNorADeviceAndNoInput) {
    const test::TempDir folder;
    ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
    for (const std::filesystem::path& file :
         {folder / "pipe", folder / "none", folder.path(), std::filesystem::path("/dev/zero")})
        EXPECT_FALSE(open_own_file(file)) << file;
    std::ofstream(folder / "own.txt") << "text";
    std::string word;
    EXPECT_TRUE(open_own_file(folder / "own.txt") >> word);
    EXPECT_EQ(word, "text");
    EXPECT_FALSE(is_input(folder / "own.txt"));
    EXPECT_TRUE(open_input(folder / "own.txt", "own.txt", "text"));
    EXPECT_TRUE(is_input(folder / "own.txt"));
}

}  // namespace
}  // namespace uw
