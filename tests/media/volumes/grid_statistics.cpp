// ctest labels: unit
#include "media/volumes/loaded_grid.h"

#include <gtest/gtest.h>

namespace uw {
namespace {

constexpr float k_not_a_number = std::numeric_limits<float>::quiet_NaN();
constexpr float k_no_end = std::numeric_limits<float>::infinity();

TEST(GridStatistics, GoodValuesAreTakenAsTheyAre) {
    GridIntake intake;
    EXPECT_EQ(intake.take(0.5F, 1), 0.5F);
    EXPECT_EQ(intake.take(2.0F, 512), 2.0F);  // a tile
    EXPECT_EQ(intake.take(0.25F, 1), 0.25F);
    const GridStatistics statistics = intake.statistics(0);
    EXPECT_EQ(statistics.active_voxels, 514);
    EXPECT_EQ(statistics.min, 0.25);
    EXPECT_EQ(statistics.max, 2);
    EXPECT_EQ(statistics.mean, (0.5 + 1024 + 0.25) / 514);
    EXPECT_TRUE(intake_warnings(statistics, "g: ").empty());
}

TEST(GridStatistics, BadValuesAreZeroAndCounted) {
    GridIntake intake;
    EXPECT_EQ(intake.take(k_not_a_number, 3), 0);
    EXPECT_EQ(intake.take(k_no_end, 1), 0);
    EXPECT_EQ(intake.take(-k_no_end, 1), 0);
    EXPECT_EQ(intake.take(-0.5F, 8), 0);
    EXPECT_EQ(intake.take(1.0F, 1), 1);
    const GridStatistics statistics = intake.statistics(-2);
    EXPECT_EQ(statistics.min, 0);
    EXPECT_EQ(statistics.mean, 1.0 / 14);
    EXPECT_EQ(intake_warnings(statistics, "g: "),
              (std::vector<std::string>{
                  "g: 3 of 14 active voxels are NaN: treated as 0",
                  "g: 2 of 14 active voxels are infinite: treated as 0",
                  "g: 8 of 14 active voxels are negative: treated as 0",
                  "g: its background is -2: treated as 0 outside the active voxels"}));
}

TEST(GridStatistics, OfPartsAddUp) {
    GridIntake whole, first, second;
    for (const float value : {1.0F, -3.0F, 0.5F}) first.take(value, 2), whole.take(value, 2);
    for (const float value : {7.0F, k_not_a_number}) second.take(value, 1), whole.take(value, 1);
    first.add(second);
    first.add(GridIntake());  // a part without voxels
    const GridStatistics a = first.statistics(0), b = whole.statistics(0);
    EXPECT_EQ(a.active_voxels, b.active_voxels);
    EXPECT_EQ(a.negative_voxels, b.negative_voxels);
    EXPECT_EQ(a.nan_voxels, b.nan_voxels);
    EXPECT_EQ(a.min, b.min);
    EXPECT_EQ(a.mean, b.mean);
    EXPECT_EQ(a.max, b.max);
}

TEST(GridStatistics, GridsThatAddNothingAreWarnedOf) {
    const GridStatistics none = GridIntake().statistics(0);
    EXPECT_EQ(none.min, 0);
    EXPECT_EQ(none.max, 0);
    EXPECT_EQ(intake_warnings(none, ""),
              (std::vector<std::string>{"it has no active voxels and contributes nothing"}));
    GridIntake dark;
    dark.take(0, 5);
    dark.take(-1, 1);
    EXPECT_EQ(intake_warnings(dark.statistics(0), "").back(),
              "all its active voxels are 0 and it contributes nothing");
}

}  // namespace
}  // namespace uw
