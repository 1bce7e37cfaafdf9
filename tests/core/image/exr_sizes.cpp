// ctest labels: unit
#include "core/image/exr_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cstdint>
#include <fstream>
#include <string>

#include "tests/support/temp_dir.h"

namespace uw {
namespace {

std::string number(std::uint32_t value) {
    return {reinterpret_cast<const char*>(&value), sizeof value};
}

std::string attribute(const std::string& name, const std::string& type, std::uint32_t size,
                      const std::string& value) {
    return name + '\0' + type + '\0' + number(size) + value;
}

class ExrSizes : public testing::Test {
  protected:
    std::filesystem::path write(const std::string& attributes, std::uint32_t version = 2) const {
        std::ofstream(dir_ / "a.exr", std::ios::binary)
            << number(20000630) << number(version) << attributes;
        return dir_ / "a.exr";
    }
    test::TempDir dir_;
};

TEST_F(ExrSizes, FitWhereTheBytesAreThere) {
    const std::string one = attribute("a", "string", 3, "xyz"), end(1, '\0');
    EXPECT_TRUE(exr_attributes_fit(write(one + one + end)));
    EXPECT_FALSE(exr_attributes_fit(write(one + one)));  // no end
    EXPECT_FALSE(exr_attributes_fit(write(one + attribute("b", "box2i", 16, "short") + end)));
    EXPECT_FALSE(exr_attributes_fit(write(attribute("b", "box2i", 0xffffffff, "xyz") + end)));
    EXPECT_FALSE(exr_attributes_fit(write(attribute(std::string(256, 'n'), "a", 0, "") + end)));
    EXPECT_FALSE(exr_attributes_fit(dir_ / "none.exr"));
    // Several parts: two headers, each with its end, and the end of headers.
    EXPECT_TRUE(exr_attributes_fit(write(one + end + one + end + end, 0x1002)));
    EXPECT_FALSE(exr_attributes_fit(
        write(one + end + attribute("b", "string", 9, "xyz") + end + end, 0x1002)));
}

long peak_kilobytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss;
}

// A text of 2 GB in a file of 40 bytes takes no memory.
TEST_F(ExrSizes, AreCheckedBeforeOpenExrReadsThem) {
    const long before = peak_kilobytes();
    EXPECT_FALSE(read_exr_header(write(attribute("a", "string", 0x7fffffff, "xyz"))));
    EXPECT_LT(peak_kilobytes() - before, 100'000);
}

}  // namespace
}  // namespace uw
