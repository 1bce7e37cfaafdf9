// ctest labels: unit
#include "fit/unknowns.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/scene/scene_desc.h"
#include "tests/support/cli_test.h"
#include "tests/support/message_of.h"

namespace uw::test {
namespace {

SceneUnknowns unknowns_of(const std::vector<std::string>& keys) {
    return {scene_tree(k_small_scene, "scene.yaml"), "scene.yaml", keys};
}

TEST(SceneUnknowns, AreTheNumbersOfLists) {
    const SceneUnknowns unknowns = unknowns_of({"water.absorption", "lamps.*.position[2]"});
    ASSERT_EQ(unknowns.size(), 4U);
    EXPECT_EQ(unknowns.all()[1].name, "water.absorption[1]");
    EXPECT_EQ(unknowns.all()[1].start, 0.08);
    EXPECT_EQ(unknowns.all()[3].name, "lamps.left.position[2]");
    const std::vector<double> values{0.5, 0.25, 0.125, -1};
    const SceneDesc scene = unknowns.scene(values);
    ASSERT_TRUE(scene.water.absorption.has_value());
    EXPECT_EQ(*scene.water.absorption, (PerBand{0.5, 0.25, 0.125}));
    EXPECT_EQ(scene.lamps[0].position.z, -1);
}

// As paths of --set, brackets included.
TEST(SceneUnknowns, ArePathsAsOfSet) {
    for (const char* key : {"lamps.*.position[2]", "lamps[*].position[2]", "lamps.left.position[2]",
                            "lamps.'left'.position.[2]"}) {
        const SceneUnknowns unknowns = unknowns_of({key});
        ASSERT_EQ(unknowns.size(), 1U) << key;
        EXPECT_EQ(unknowns.scene(std::vector{-1.0}).lamps[0].position.z, -1) << key;
    }
    EXPECT_NE(message_of<UsageError>([] {
                  unknowns_of({"volumes.*.voxel_size"});
              }).find("the scene has nothing of that kind"),
              std::string::npos);
}

TEST(SceneUnknowns, EndWhereScenesDo) {
    const SceneUnknowns unknowns =
        unknowns_of({"water.absorption[0]", "water.scattering.phase.g", "lamps.left.position"});
    EXPECT_EQ(unknowns.all()[0].lower, 0);
    EXPECT_TRUE(std::isinf(unknowns.all()[0].upper));
    EXPECT_NEAR(unknowns.all()[1].upper, 1, 1e-6);
    EXPECT_TRUE(std::isinf(unknowns.all()[2].lower));
}

TEST(SceneUnknowns, TiltDirections) {
    const SceneUnknowns unknowns = unknowns_of({"lamps.left.direction"});
    ASSERT_EQ(unknowns.size(), 2U);
    EXPECT_EQ(unknowns.all()[0].unit, "deg");
    const Vector3 before = glm::normalize(Vector3{0.1, 0, 1});
    const std::vector<double> values{3, 0};
    const SceneDesc scene = unknowns.scene(values);
    EXPECT_NEAR(std::acos(glm::dot(scene.lamps[0].direction, before)) / k_degree, 3, 1e-9);
    EXPECT_EQ(unknowns.settings(values)[0].first, "lamps.left.direction");
}

TEST(SceneUnknowns, SayWhatIsWrongWithKeys) {
    EXPECT_EQ(message_of<UsageError>([] { unknowns_of({"water.absorbtion"}); }),
              "--unknown water.absorbtion: the scene has no water.absorbtion; did you mean "
              "'absorption'?");
    EXPECT_EQ(message_of<UsageError>([] { unknowns_of({"camera.line_time"}); }),
              "--unknown camera.line_time: the scene has no camera.line_time; write there what you "
              "expect, from where the fit begins");
    EXPECT_EQ(message_of<UsageError>([] { unknowns_of({"lamps.*.profile"}); }),
              "--unknown lamps.*.profile: lamps.left.profile is a map; name a number or a list of "
              "numbers");
    EXPECT_EQ(message_of<UsageError>([] {
                  unknowns_of({"water.absorption", "water.absorption[1]"});
              }),
              "--unknown: water.absorption[1] is named twice; leave one out");
    EXPECT_EQ(message_of<UsageError>([] { unknowns_of({"water"}).within("lamps"); }),
              "--unknown water: water is a map; name a number or a list of numbers");
    EXPECT_EQ(message_of<UsageError>([] { unknowns_of({"water.absorption"}).within("lamps"); }),
              "lamps: none of the unknowns is called that");
}

}  // namespace
}  // namespace uw::test
