// ctest labels: unit
#include "media/water/phase_functions.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>

#include "core/base/error.h"
#include "tests/support/phase_function_laws.h"
#include "tests/support/water_descs.h"

namespace uw {
namespace {

using namespace test;

class PhaseTableFile : public ::testing::Test {
  protected:
    void SetUp() override {
        std::string pattern = (std::filesystem::temp_directory_path() / "uwvdb-XXXXXX").string();
        ASSERT_NE(mkdtemp(pattern.data()), nullptr);
        folder_ = pattern;
        file_ = folder_ / "phase.csv";
        phase_.where = "scene.yaml:5:9: water.scattering.phase.file";
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    WaterModel build(const std::string& text) {
        std::ofstream(file_) << text;
        return build();
    }
    WaterModel build() {
        phase_.function = TabulatedPhaseDesc{file_};
        WaterDesc water = basic_water();
        water.scattering = ScatteringDesc{{0.2, 0.2, 0.2}, phase_};
        return build_water_model(water, {});
    }

    std::filesystem::path folder_, file_;
    PhaseDesc phase_;
};

TEST_F(PhaseTableFile, IsReadAndNormalised) {
    const WaterModel model = build("# 1/sr\nangle_deg,phase\n0,0.0796\n180,0.0796\n");
    EXPECT_TRUE(model.warnings.empty());
    expect_phase_function_laws(*model.medium.phase_functions.at(0));
    EXPECT_NEAR(model.medium.phase_functions[0]->eval(1), 1 / (4 * std::numbers::pi), 1e-12);
}

TEST_F(PhaseTableFile, WarnsOfWhatIsNoPhaseFunction) {
    EXPECT_EQ(build("angle_deg,phase\n0,1\n180,1\n").warnings.size(), 1U);   // 4 pi
    const WaterModel cut = build("angle_deg,phase\n0,0.0796\n90,0.0796\n");  // half is missing
    ASSERT_EQ(cut.warnings.size(), 1U);
    EXPECT_NE(cut.warnings[0].find("50 %"), std::string::npos) << cut.warnings[0];
}

TEST_F(PhaseTableFile, ErrorsSayWhere) {
    EXPECT_THROW(build(), IoError);
    const std::string message = refusal([&] { build("angle_deg,phase\n0,1\n"); });
    EXPECT_EQ(message.find(phase_.where), 0U) << message;
    EXPECT_NE(message.find("phase.csv"), std::string::npos) << message;
    EXPECT_THROW(build(std::string(5 << 20, '1')), InputError);  // larger than any table
    EXPECT_THROW(build(std::string("\0\xff\n\0,\n", 6)), InputError);
    file_ = "/dev/zero";
    EXPECT_THROW(build(), IoError);
}

}  // namespace
}  // namespace uw
