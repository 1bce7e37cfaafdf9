// ctest labels: unit
#include "core/base/progress.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

namespace uw {
namespace {

TEST(Stages, AreKnownByTheirNames) {
    for (int i = 0; i <= static_cast<int>(Stage::derivatives); ++i) {
        const auto stage = static_cast<Stage>(i);
        EXPECT_EQ(stage_named(name_of(stage)), stage) << name_of(stage);
    }
    EXPECT_THROW(stage_named("Render"), std::invalid_argument);
    EXPECT_THROW(stage_named(""), std::invalid_argument);
}

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

TEST(Stages, AreToldByNameAsWell) {
    std::vector<std::pair<Stage, double>> told;
    const StageProgressCallback progress = [&](Stage stage, double fraction) {
        told.emplace_back(stage, fraction);
    };
    progress(Stage::snow, 0);
    progress("forward scatter", 0.5);
    EXPECT_EQ(told, (std::vector<std::pair<Stage, double>>{{Stage::snow, 0},
                                                           {Stage::forward_scatter, 0.5}}));
}

}  // namespace
}  // namespace uw
