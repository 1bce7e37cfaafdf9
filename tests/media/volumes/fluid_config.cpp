// ctest labels: unit
#include "media/volumes/fluid_domain.h"

#include <gtest/gtest.h>

#include <cmath>
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

// The box is that which the object had in Blender when these were baked.
TEST_F(FluidConfigTest, HasTheDomainsBox) {
    const auto plain = read(test::blender_config());
    ASSERT_TRUE(plain && plain->blender_from_domain);
    EXPECT_LT(glm::length(plain->sides - Vector3(2.4, 1.8, 2)), 1e-6);
    EXPECT_LT(glm::length(plain->blender_from_domain->offset() - Vector3(-0.9, -1.1, 0)), 1e-6);
    const auto turned = read(test::blender_stretched_config());
    ASSERT_TRUE(turned && turned->blender_from_domain);
    EXPECT_LT(glm::length(turned->sides - Vector3(1.4, 1.2, 1.7)), 1e-6);
    const Point3 middle = *turned->blender_from_domain * Point3{0.7, 0.6, 0.85};
    EXPECT_LT(distance(middle, Point3{0.3, -0.5, 1.1}), 1e-6);
    const Vector3 along_x = turned->blender_from_domain->apply_to_vector({1, 0, 0});
    EXPECT_LT(glm::length(along_x - Vector3(std::cos(30 * k_degree), 0.5, 0)), 1e-6);
}

// Two frames, ten apart, of scenes with 24 frames a second.
TEST_F(FluidConfigTest, TellsTheFrameRate) {
    EXPECT_FALSE(fluid_frame_rate(dir_ / "data/fluid_data_0002.vdb"));
    read(test::blender_config());
    std::ofstream(dir_ / "config/config_0012.uni", std::ios::binary)
        << test::blender_stretched_config();
    const std::filesystem::path first = dir_ / "data/fluid_data_0002.vdb";
    std::ofstream(first) << "x";
    EXPECT_FALSE(fluid_frame_rate(first));  // a single frame tells nothing
    std::ofstream(dir_ / "data/fluid_data_0012.vdb") << "x";
    EXPECT_EQ(fluid_frame_rate(first), 24);
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
