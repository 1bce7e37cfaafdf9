// ctest labels: unit
#include "core/light/ray_panels.h"

#include <gtest/gtest.h>

namespace uw::test {
namespace {

using Breaks = std::vector<double>;

TEST(PanelBreaks, AreTheEndsWhereNothingIsAdded) {
    PanelBreaks breaks;
    breaks.reset({1, 3});
    EXPECT_EQ(breaks.kept(), (Breaks{1, 3}));
}

TEST(PanelBreaks, KeepEveryEdgeInsideInOrder) {
    PanelBreaks breaks;
    breaks.reset({1, 3});
    for (const double s : {2.5, 1.001, 0.5, 3.5, 1.0, 3.0}) breaks.add_edge(s);
    EXPECT_EQ(breaks.kept(), (Breaks{1, 1.001, 2.5, 3}));
}

TEST(PanelBreaks, LeaveOutMarksThatFollowTooClosely) {
    PanelBreaks breaks;
    breaks.reset({0, 10});
    for (const double s : {0.5, 1.0, 1.5, 2.0, 6.0}) breaks.add_mark(s, 1.0);
    EXPECT_EQ(breaks.kept(), (Breaks{0, 1, 2, 6, 10}));
}

TEST(PanelBreaks, PutAnEdgeInPlaceOfTheMarkBeforeIt) {
    PanelBreaks breaks;
    breaks.reset({0, 10});
    breaks.add_mark(3.0, 1.0);
    breaks.add_edge(3.5);
    breaks.add_edge(3.6);
    breaks.add_mark(9.5, 1.0);
    EXPECT_EQ(breaks.kept(), (Breaks{0, 3.5, 3.6, 10}));
}

TEST(PanelBreaks, BeginAnewOnReset) {
    PanelBreaks breaks;
    breaks.reset({0, 10});
    breaks.add_edge(3.0);
    breaks.reset({2, 4});
    EXPECT_EQ(breaks.kept(), (Breaks{2, 4}));
}

}  // namespace
}  // namespace uw::test
