// ctest labels: metamorphic slow
// Water from pictures of all light, by another integrator than the one that it is fitted with.
#include <gtest/gtest.h>

#include <string>

#include "core/base/json.h"
#include "tests/support/fit_pictures.h"

namespace uw::test {
namespace {

// Light paths have noise of their own in each pixel, and nothing that is interpolated. Errors do
// not hold all of the fast form's noise: four of them.
TEST_F(FitPictures, WaterOfAllLight) {
    std::string text = k_dive;
    text.replace(text.find("SENSOR"), 6, "");
    text.replace(text.find("{fps: 1}"), 8, "{fps: 1, scattering: multiple}");
    write("dive.yaml", text);
    const ProgramResult result =
        run({"render", "dive.yaml", "-o", "dive_%02d.exr", "--frames", "0-2", "--quiet",
             "--integrator", "path", "--samples", "300"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const ProgramResult fitted = run(
        {"fit", "dive.yaml", "--images", "dive_%02d.exr", "--unknown",
         "water.absorption,water.scattering.b", "--set", "water.absorption=[0.2416, 0.093, 0.0546]",
         "--set", "water.scattering.b=[0.41, 0.29, 0.303]", "--cells", "28", "--json"});
    ASSERT_EQ(fitted.exit_code, 0) << fitted.err;
    const Json found = Json::parse(fitted.out);
    EXPECT_TRUE(found.at("converged").get<bool>());
    expect_found(found,
                 {{"water.absorption[0]", 0.25},
                  {"water.absorption[1]", 0.09},
                  {"water.absorption[2]", 0.05},
                  {"water.scattering.b[0]", 0.30},
                  {"water.scattering.b[1]", 0.32},
                  {"water.scattering.b[2]", 0.35}},
                 4, 0);
}

}  // namespace
}  // namespace uw::test
