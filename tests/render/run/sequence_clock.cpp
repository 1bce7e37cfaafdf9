// ctest labels: unit
#include "render/run/run_engine.h"

#include <gtest/gtest.h>

namespace uw {
namespace {

TEST(SequenceClock, OfOneImageHasNoNumbers) {
    SequenceClock clock(1);
    EXPECT_FALSE(clock.is_sequence());
    EXPECT_EQ(clock.label("render"), "render");
    EXPECT_FALSE(clock.seconds_left());
    clock.finish_image();
    EXPECT_TRUE(clock.finished());
    EXPECT_FALSE(clock.seconds_left());
}

TEST(SequenceClock, CountsImages) {
    SequenceClock clock(3, "image");
    EXPECT_EQ(clock.label("splat"), "image 1 of 3: splat");
    clock.finish_image();
    EXPECT_EQ(clock.images_done(), 1U);
    EXPECT_EQ(clock.label("render"), "image 2 of 3: render");
    EXPECT_FALSE(clock.finished());
}

TEST(SequenceClock, ForetellsByWhatHasPassed) {
    SequenceClock clock(4);
    EXPECT_FALSE(clock.seconds_left());  // nothing to go by yet
    clock.finish_image();
    const double three = clock.seconds_left().value();
    EXPECT_GE(three, 0);
    clock.finish_image();
    clock.finish_image();
    clock.finish_image();
    EXPECT_EQ(clock.seconds_left().value(), 0);
}

}  // namespace
}  // namespace uw
