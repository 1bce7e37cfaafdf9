// ctest labels: unit
#include "edit/server/page_files.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace {

using namespace uw;

// Every file of the folder is in the program, byte for byte: what the build embeds is what is
// there.
TEST(PageFiles, AreThoseOfTheFolder) {
    const std::filesystem::path folder = UWVDB_SOURCE_DIR "/edit/page";
    std::size_t count = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        if (!entry.is_regular_file()) continue;
        const std::string name = entry.path().lexically_relative(folder).generic_string();
        std::ifstream stream(entry.path(), std::ios::binary);
        const std::string text(std::istreambuf_iterator<char>(stream), {});
        const PageFile* file = find_page_file(name);
        ASSERT_NE(file, nullptr) << name;
        EXPECT_EQ(file->text, text) << name;
        EXPECT_NE(content_type(name), "application/octet-stream") << name;
        ++count;
    }
    EXPECT_EQ(count, page_files().size());
    EXPECT_NE(find_page_file("index.html"), nullptr);
    EXPECT_EQ(find_page_file("../page/index.html"), nullptr);
}

}  // namespace
