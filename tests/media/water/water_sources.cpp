// ctest labels: unit
#include "media/inspection/water_table.h"

#include <gtest/gtest.h>

#include "tests/support/water_descs.h"

namespace uw {
namespace {

using test::basic_water;
using test::particle_grid;

bool line_has(const std::string& line, const std::string& part) {
    return line.find(part) != std::string::npos;
}

TEST(WaterSources, OfClearWaterAreTwo) {
    WaterDesc water = basic_water();
    water.temperature = 10;
    const auto lines = water_sources(water, {}, 0, 0);
    ASSERT_EQ(lines.size(), 2U);
    EXPECT_EQ(lines[0],
              "absorption: pure water, WOPP v3 (Roettgers et al. 2016), 10 deg C, 35 PSU");
    EXPECT_EQ(lines[1],
              "scattering: water's molecules, Einstein-Smoluchowski (Morel 1974), 35 PSU");
}

TEST(WaterSources, NameWhatIsInTheWater) {
    WaterDesc water = basic_water();
    water.cdom = 0.2;
    water.chlorophyll = 1.5;
    water.mineral_absorption = true;
    const auto lines = water_sources(water, {}, 0.01, 0.02);
    EXPECT_TRUE(line_has(lines[0], "; dissolved matter 0.2 1/m at 440 nm")) << lines[0];
    EXPECT_TRUE(line_has(lines[0], "; chlorophyll 1.5 mg/m^3")) << lines[0];
    EXPECT_TRUE(line_has(lines[0], "; particles as mineral (Babin et al. 2003)")) << lines[0];
    EXPECT_TRUE(line_has(lines[1], "0.01 ppm small, 0.02 ppm large")) << lines[1];
    // Mineral particles absorb only where there are some.
    EXPECT_FALSE(line_has(water_sources(water, {}, 0, 0)[0], "mineral"));
}

TEST(WaterSources, OfAPresetAreItsMeasurements) {
    WaterDesc water = basic_water();
    water.preset = "jerlov-ii";
    const auto lines = water_sources(water, {}, 0.01, 0.02);
    EXPECT_TRUE(line_has(lines[0], "jerlov-II as measured from")) << lines[0];
    EXPECT_TRUE(line_has(lines[1], "to scatter as jerlov-II (Williamson and Hollins 2022)"))
        << lines[1];
    water.small_ppm = 0.01;
    water.large_ppm = 0.02;
    EXPECT_FALSE(line_has(water_sources(water, {}, 0.01, 0.02)[1], "to scatter as"));
}

TEST(WaterSources, NumbersAsGivenHaveNoOther) {
    WaterDesc water = basic_water();
    water.preset = "jerlov-II";
    water.absorption = PerBand{0.3, 0.1, 0.1};
    water.scattering = ScatteringDesc{{0.2, 0.2, 0.2}, {}};
    water.cdom = 0.2;
    EXPECT_EQ(water_sources(water, {}, 0, 0),
              (std::vector<std::string>{"absorption: as given per band",
                                        "scattering: as given per band, with one phase function"}));
}

TEST(WaterSources, EachGridHasALine) {
    VolumeDesc volume;
    volume.file = "/data/plume.vdb";
    volume.grids = {particle_grid("density", 2, 10), particle_grid("dye", 0, 0)};
    volume.grids[1].optics = GridMappingDesc::Optics{{1, 1, 1}, {0, 0, 0}, std::nullopt};
    const auto lines = water_sources(basic_water(), {volume}, 0, 0);
    ASSERT_EQ(lines.size(), 4U);
    EXPECT_EQ(lines[2], "grid 'density' of plume.vdb: 1 unit is 2 ppm small, 10 ppm large");
    EXPECT_EQ(lines[3],
              "grid 'dye' of plume.vdb: 1 unit is coefficients as given, with the water's phase "
              "function");
}

}  // namespace
}  // namespace uw
