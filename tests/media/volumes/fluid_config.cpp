// ctest labels: unit
#include "media/volumes/adaptive_domain.h"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/temp_dir.h"
#include "tests/support/vdb/fluid_configs.h"

namespace uw {
namespace {

class FluidConfigTest : public testing::Test {
  protected:
    std::optional<FluidConfig> read(const std::string& bytes) const {
        std::filesystem::create_directories(dir_ / "config");
        std::filesystem::create_directories(dir_ / "data");
        std::ofstream(dir_ / "config/config_0002.uni", std::ios::binary) << bytes;
        return read_fluid_config(dir_ / "data/fluid_data_0002.vdb");
    }
    test::TempDir dir_;
};

TEST_F(FluidConfigTest, IsReadAsBlenderWroteIt) {
    const auto config = read(test::blender_config());
    ASSERT_TRUE(config);
    EXPECT_EQ(config->resolution, (std::array{19, 19, 19}));
    EXPECT_EQ(config->domain, (std::array{48, 36, 40}));
    EXPECT_EQ(config->first, (std::array{20, 12, 0}));
}

TEST_F(FluidConfigTest, WhatIsNoneIsLeft) {
    EXPECT_FALSE(read_fluid_config(dir_ / "data/fluid_data_0002.vdb"));
    EXPECT_FALSE(read_fluid_config("no_number.vdb"));
    const std::string bytes = test::blender_config();
    EXPECT_FALSE(read(bytes.substr(0, bytes.size() / 2)));
    EXPECT_FALSE(read(""));
    EXPECT_FALSE(read(std::string(400, '\0')));
    EXPECT_FALSE(read(std::string(400, '\x7f')));
}

}  // namespace
}  // namespace uw
