// ctest labels: unit
#include "core/image/spectral_bands.h"

#include <gtest/gtest.h>

#include <array>

namespace uw {
namespace {

using BandList = std::vector<double>;

TEST(BandIntervals, MeetHalfway) {
    const auto intervals = band_intervals(BandList{400, 420, 500});
    ASSERT_EQ(intervals.size(), 3U);
    EXPECT_EQ(intervals[0].begin, 390);  // as far out as in
    EXPECT_EQ(intervals[0].end, 410);
    EXPECT_EQ(intervals[1].begin, 410);
    EXPECT_EQ(intervals[1].end, 460);
    EXPECT_EQ(intervals[2].begin, 460);
    EXPECT_EQ(intervals[2].end, 540);
    EXPECT_EQ(mean_band_width(intervals), (540.0 - 390) / 3);
}

TEST(BandIntervals, KeepTheOrderOfTheBands) {
    const BandList ascending{450, 540, 620};
    const auto sorted = band_intervals(ascending);
    const std::array<std::size_t, 3> order{2, 0, 1};
    BandList shuffled;
    for (const std::size_t i : order) shuffled.push_back(ascending[i]);
    const auto intervals = band_intervals(shuffled);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(intervals[i].begin, sorted[order[i]].begin);
        EXPECT_EQ(intervals[i].end, sorted[order[i]].end);
    }
}

TEST(BandIntervals, OfEvenBandsAreTheirStep) {
    BandList bands;
    for (int i = 0; i < 31; ++i) bands.push_back(400 + 10 * i);
    const auto intervals = band_intervals(bands);
    for (const BandInterval& interval : intervals) EXPECT_EQ(interval.width(), 10);
    EXPECT_EQ(mean_band_width(intervals), 10);
}

TEST(BandIntervals, OfOneBandHasNoWidth) {
    const auto intervals = band_intervals(BandList{550});
    ASSERT_EQ(intervals.size(), 1U);
    EXPECT_EQ(intervals[0].begin, 550);
    EXPECT_EQ(intervals[0].width(), 0);
    EXPECT_EQ(mean_band_width(intervals), 0);
}

}  // namespace
}  // namespace uw
