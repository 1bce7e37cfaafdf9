// ctest labels: unit
#include "core/base/progress.h"

#include <gtest/gtest.h>

namespace uw {
namespace {

// Scripts read them, in `--stats`, in lines of progress and in Python.
TEST(Stages, HaveTheNamesThatUsersKnow) {
    EXPECT_EQ(name_of(Stage::particles), "particles");
    EXPECT_EQ(name_of(Stage::volumes), "volumes");
    EXPECT_EQ(name_of(Stage::geometry), "geometry");
    EXPECT_EQ(name_of(Stage::splat), "splat");
    EXPECT_EQ(name_of(Stage::multiple_scattering), "multiple scattering");
    EXPECT_EQ(name_of(Stage::snow), "snow");
    EXPECT_EQ(name_of(Stage::render), "render");
    EXPECT_EQ(name_of(Stage::forward_scatter), "forward scatter");
    EXPECT_EQ(name_of(Stage::reflection), "reflection");
    EXPECT_EQ(name_of(Stage::derivatives), "derivatives");
}

}  // namespace
}  // namespace uw
