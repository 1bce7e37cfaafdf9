// ctest labels: unit
#include "cli/info/vdb_advice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/temp_dir.h"
#include "tests/support/vdb/vdb_fixtures.h"

namespace uw {
namespace {

class VdbAdviceTest : public testing::Test {
  protected:
    /// A box of 20 voxels along each edge.
    static test::VdbFixture cube(const std::string& name, double voxel = 0.05) {
        test::VdbFixture fixture;
        fixture.name = name;
        fixture.boxes = {{{0, 0, 0}, {19, 19, 19}, 1}};
        fixture.file_from_index = Affine::scale(Vector3(voxel));
        return fixture;
    }
    VdbAdvice advise(const std::vector<test::VdbFixture>& grids) const {
        test::write_fixture(dir_ / "a.vdb", grids);
        return advise_on_vdb(inspect_vdb(dir_ / "a.vdb", "here"), "my plume.vdb");
    }
    static bool says(const VdbAdvice& advice, const std::string& part) {
        return std::ranges::any_of(advice.lines, [&](const std::string& line) {
            return line.find(part) != std::string::npos;
        });
    }
    test::TempDir dir_;
};

using GridNames = std::vector<std::string>;

TEST(ConcentrationLikelihood, IsToldByTheName) {
    for (const char* name : {"density", "Smoke_Density", "density_noise"})
        EXPECT_EQ(concentration_likelihood(name), 4) << name;
    for (const char* name : {"smoke", "Sediment", "dye2"})
        EXPECT_EQ(concentration_likelihood(name), 3) << name;
    for (const char* name : {"x", "", "amount"})
        EXPECT_EQ(concentration_likelihood(name), 2) << name;
    for (const char* name : {"temperature", "heat", "flame"})
        EXPECT_EQ(concentration_likelihood(name), 1) << name;
    for (const char* name : {"vel", "Cd", "phi_in", "surface", "shadow_density"})
        EXPECT_EQ(concentration_likelihood(name), 0) << name;
}

TEST_F(VdbAdviceTest, MapsTheLikeliest) {
    const VdbAdvice advice = advise({cube("heat"), cube("density"), cube("dye")});
    EXPECT_EQ(advice.map, GridNames{"density"});
    EXPECT_TRUE(says(advice, "Map 'density': the name says density."));
    EXPECT_TRUE(says(advice, "Not a concentration by name: 'heat'."));
    EXPECT_EQ(advise({cube("heat")}).map, GridNames{"heat"});  // for want of another
    const VdbAdvice namesakes = advise({cube("density"), cube("density")});
    EXPECT_EQ(namesakes.map, (GridNames{"density[0]", "density[1]"}));
}

TEST_F(VdbAdviceTest, WithoutAConcentrationThereIsNoBlock) {
    const VdbAdvice advice = advise({cube("shadow")});
    EXPECT_TRUE(advice.map.empty());
    EXPECT_EQ(advice.volumes, "");
    EXPECT_TRUE(says(advice, "Nothing to map"));
    test::VdbFixture negative = cube("density");
    negative.boxes[0].value = -1;
    EXPECT_TRUE(says(advise({negative}), "has no value above 0"));
}

TEST_F(VdbAdviceTest, TheBlockNamesTheFileAsTheSceneHasIt) {
    const VdbAdvice advice = advise({cube("density")});
    EXPECT_TRUE(advice.volumes.starts_with("volumes:\n  - file: 'my plume.vdb'\n"))
        << advice.volumes;
    EXPECT_NE(advice.volumes.find("      density: {small: "), std::string::npos) << advice.volumes;
    EXPECT_NE(advice.volumes.find("    up: y\n"), std::string::npos) << advice.volumes;
}

TEST_F(VdbAdviceTest, UnitsThatAreUnlikelyGetAScale) {
    EXPECT_EQ(advise({cube("density", 0.05)}).scale, 1);  // 1 m
    const VdbAdvice unset = advise({cube("density", 1)});
    EXPECT_TRUE(says(unset, "a voxel is exactly 1 m"));
    EXPECT_NEAR(unset.scale * 20, 2, 1e-9);
    const VdbAdvice centimetres = advise({cube("density", 5)});  // 100 m
    EXPECT_EQ(centimetres.scale, 0.01);
    EXPECT_TRUE(says(centimetres, "if these are centimetres"));
    EXPECT_EQ(advise({cube("density", 0.001)}).scale, 100);  // 2 cm
}

TEST_F(VdbAdviceTest, TheEyeSeesAllOfIt) {
    const VdbAdvice advice = advise({cube("density")});
    const Vector3 view = advice.target - advice.eye;
    const double radius = 0.5 * advice.bounds.diagonal();
    EXPECT_LT(std::asin(radius / glm::length(view)), glm::radians(25.0));
    EXPECT_LT(distance(advice.target, advice.bounds.center()), 1e-12);
}

}  // namespace
}  // namespace uw
