// ctest labels: unit
#include "cli/grid_summary.h"

#include <gtest/gtest.h>

namespace uw {
namespace {

/// Two bands and two constituents with attenuations of 0.5 and 2, and of 0 and 3.
Medium medium_of_two_constituents() {
    Medium medium;
    medium.wavelengths_nm = {620, 450};
    medium.constituents = {{"small", "ppm", {}}, {"dye", "1", {}}};
    medium.constituents[0].per_unit.absorption[0] = 0.5;
    medium.constituents[0].per_unit.scattering.resize(1);
    medium.constituents[0].per_unit.scattering[0][1] = 2;
    medium.constituents[1].per_unit.absorption[1] = 3;
    return medium;
}

VolumeReport report_on_a_plume() {
    VolumeReport report;
    report.file = "/data/plume.vdb";
    report.grid = "density";
    report.metres_per_voxel = {0.01, 0.02, 0.04};
    report.bounds = {{-1, 0, 2}, {1, 3, 5}};
    report.statistics.active_voxels = 1234;
    report.bytes = 2500000;
    report.placement = {Centering::cell, UpAxis::z, true, false};
    ConstituentReport small, dye;
    small.constituent = 0;
    small.min = 0, small.mean = 0.25, small.max = 2;
    small.column = {1, 2, 3};
    dye.constituent = 1;
    dye.max = 0.5;
    dye.column = {0.1, 0.2, 0.3};
    report.constituents = {small, dye};
    return report;
}

TEST(GridSummary, DepthIsThatOfEachConstituentsColumn) {
    const Medium medium = medium_of_two_constituents();
    const VolumeReport report = report_on_a_plume();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto column = static_cast<double>(axis + 1);
        const std::vector<double> depth = depth_through_middle(report, medium, axis);
        ASSERT_EQ(depth.size(), 2U);
        EXPECT_NEAR(depth[0], 0.5 * column, 1e-14);
        EXPECT_NEAR(depth[1], 2 * column + 3 * 0.1 * column, 1e-14);
    }
}

TEST(GridSummary, SaysWhatTheGridIsAndWhere) {
    EXPECT_EQ(
        describe_grid(report_on_a_plume(), medium_of_two_constituents()),
        "plume.vdb: grid 'density': 0.01 x 0.02 x 0.04 m per voxel, 1234 active voxels, "
        "2.5 MB\n"
        "  centering cell (automatic), up z\n"
        "  bounds x -1..1, y 0..3, z 2..5 m\n"
        "  small: min 0, mean 0.25, max 2 ppm; optical depth along x, y, z at 450 nm 2, 4, 6\n"
        "  dye: min 0, mean 0, max 0.5; optical depth along x, y, z at 450 nm 0.3, 0.6, 0.9\n"
        "  optical depth through the middle along x: 0.5 (620 nm), 2.3 (450 nm)\n"
        "  optical depth through the middle along y: 1 (620 nm), 4.6 (450 nm)\n"
        "  optical depth through the middle along z: 1.5 (620 nm), 6.9 (450 nm)\n");
}

TEST(GridSummary, OfAnEmptyGridIsShort) {
    VolumeReport report = report_on_a_plume();
    report.bounds = Bounds();
    const std::string text = describe_grid(report, medium_of_two_constituents());
    EXPECT_TRUE(text.ends_with("  no values above 0\n")) << text;
}

}  // namespace
}  // namespace uw
