// ctest labels: unit
#include "media/water/depth_profile.h"

#include <gtest/gtest.h>

#include "core/scene/scene_desc.h"
#include "media/inspection/water_table.h"
#include "media/water/species.h"
#include "media/water/water_model.h"
#include "media/water/water_types.h"
#include "tests/support/message_of.h"
#include "tests/support/scene_folder.h"
#include "tests/support/water_descs.h"

namespace uw {
namespace {

using namespace uw::test;

class Profile : public testing::Test {
  protected:
    WaterDesc water(const std::string& csv, const std::string& keys = "") const {
        folder_.write("ctd.csv", csv);
        return read_water_overrides(
            {"water={surface: {point: [0, 10, 0], normal: [0, 1, 0]}, profile: " +
             (folder_.path() / "ctd.csv").string() + keys + "}"});
    }

    SceneFolder folder_;
};

void expect_same(const OpticalCoefficients& a, const WaterModel& b) {
    for (std::size_t band = 0; band < b.medium.wavelengths_nm.size(); ++band) {
        EXPECT_NEAR(a.absorption[band], b.medium.uniform.absorption[band], 1e-12);
        EXPECT_NEAR(a.total_scattering()[band], b.medium.uniform.total_scattering()[band], 1e-12);
    }
}

// Each row is the uniform water with its values.
TEST_F(Profile, OfEachDepthIsUniformWaterOfItsRow) {
    const WaterModel model = build_water_model(
        water("depth_m,chlorophyll,cdom,small,silt g/m3,clay NTU\n"
              "0,2,0.1,0.02,3,0\n5,0.5,0.02,0.05,3,1\n20,0.1,0.02,0.3,3,0.2\n",
              ", species: {silt: {library: silt}, clay: {library: clay}}, particles: {large: 0.1}"),
        {});
    ASSERT_TRUE(model.strata);
    expect_consistent(model);
    const std::array rows{
        "{chlorophyll: 2, cdom: 0.1, particles: {large: 0.1, small: 0.02, silt: 3 g/m3}, ",
        "{chlorophyll: 0.5, cdom: 0.02, particles: {large: 0.1, small: 0.05, silt: 3 g/m3, clay: "
        "1 NTU}, ",
        "{chlorophyll: 0.1, cdom: 0.02, particles: {large: 0.1, small: 0.3, silt: 3 g/m3, clay: "
        "0.2 NTU}, "};
    for (std::size_t i = 0; i < rows.size(); ++i)
        expect_same(
            coefficients_by_depth(model).at(i),
            build_water_model(
                read_water_overrides({std::string("water=") + rows[i] +
                                      "species: {silt: {library: silt}, clay: {library: clay}}}"}),
                {}));
    // Silt is the same everywhere, chlorophyll absorbs in each band by a law of its own.
    EXPECT_EQ(model.medium.constituent_count(), 2 + 3);
}

TEST_F(Profile, ThatIsFlatIsUniformWater) {
    const WaterModel flat =
        build_water_model(water("depth_m,cdom,small\n0,0.1,0.02\n5,0.1,0.02\n"), {});
    EXPECT_EQ(flat.strata, nullptr);
    EXPECT_EQ(flat.medium.constituent_count(), 0);
    const WaterModel uniform = build_water_model(
        read_water_overrides({"water={cdom: 0.1, particles: {small: 0.02}}"}), {});
    EXPECT_EQ(flat.medium.uniform.absorption, uniform.medium.uniform.absorption);
    EXPECT_EQ(flat.medium.uniform.scattering, uniform.medium.uniform.scattering);
}

// What changes alike in all bands is one constituent, as two rows always do.
TEST_F(Profile, TakesCoefficientsAsTheyWereMeasured) {
    const std::string keys = ", scattering: {phase: {type: hg, g: 0.9}}";
    const WaterModel model =
        build_water_model(water("depth_m,absorption_620,absorption_540,absorption_450,attenuation\n"
                                "1,0.3,0.1,0.05,0.5\n2,0.5,0.2,0.1,0.9\n",
                                keys),
                          {});
    const OpticalCoefficients second = coefficients_by_depth(model).at(1);
    EXPECT_NEAR(second.absorption[0], 0.5, 1e-12);
    EXPECT_NEAR(second.absorption[2], 0.1, 1e-12);
    EXPECT_NEAR(second.total_scattering()[0], 0.4, 1e-12);
    EXPECT_NEAR(second.total_scattering()[2], 0.8, 1e-12);
    EXPECT_EQ(model.medium.phase_count(), 1);
    EXPECT_EQ(model.medium.constituent_count(), 2);
    const WaterTable table =
        tabulate_water(water("depth_m,absorption_620,absorption_540,absorption_450,attenuation\n"
                             "1,0.3,0.1,0.05,0.5\n2,0.5,0.2,0.1,0.9\n",
                             keys),
                       {});
    EXPECT_TRUE(table.constituents.empty());
    ASSERT_EQ(table.depths.size(), 2U);
    EXPECT_NEAR(table.absorption_at[0][1], 0.1, 1e-12);
    EXPECT_NEAR(table.scattering_at[1][1], 0.7, 1e-12);
}

TEST_F(Profile, ErrorsSayWhatIsWrong) {
    const auto expect = [&](const std::string& csv, const std::string& keys,
                            const std::string& part) {
        const std::string message =
            message_of<InputError>([&] { (void)build_water_model(water(csv, keys), {}); });
        EXPECT_NE(message.find(part), std::string::npos) << message;
        EXPECT_NE(message.find("water.profile"), std::string::npos) << message;
    };
    expect("depth_m,cdom\n2,0.1\n1,0.2\n", "", "depths do not ascend: 1 m follows 2 m");
    expect("depth,cdom\n1,0.1\n", "", "has no column depth_m");
    expect("depth_m\n1\n", "", "has no column but depth_m");
    expect("depth_m,cdmo\n1,0.1\n", "", "unknown column 'cdmo'");
    expect("depth_m,cdom\n1,-0.1\n", "", "column cdom has the value -0.1");
    expect("depth_m,cdom\n1,0.1\n", ", cdom: 0.2", "in whose place the water has cdom");
    expect("depth_m,cdom\n1,0.1\n", ", preset: jerlov-II", "in whose place the water has preset");
    expect("depth_m,small\n1,0.1\n", ", particles: {small: 1}", "particles.small");
    expect("depth_m,scattering\n1,0.1\n", "", "phase function is missing");
    expect("depth_m,cdom\n1,0.1\n", ", scattering: {phase: {type: hg, g: 0}}",
           "has no column scattering");
    expect("depth_m,absorption_620,absorption_450\n1,0.1,0.1\n", "",
           "has no column absorption_540");
    expect("depth_m,attenuation\n1,0.1\n", "", "attenuation needs one of");
    EXPECT_NE(message_of<InputError>([&] {
                  folder_.write("ctd.csv", "depth_m,cdom\n1,0.1\n");
                  (void)read_water_overrides(
                      {"water={profile: " + (folder_.path() / "ctd.csv").string() + "}"});
              }).find("add surface"),
              std::string::npos);
}

}  // namespace
}  // namespace uw
