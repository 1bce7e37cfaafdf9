// ctest labels: analytic slow
// What `uwvdb validate` compares without a scene, and the example of uniform water as it is but for
// its size.
#include <gtest/gtest.h>

#include <sstream>

#include "cli/validate/validate_command.h"

namespace uw::test {
namespace {

TEST(ValidationSuite, Passes) {
    ValidateArguments arguments;
    arguments.quiet = true;
    std::ostringstream out;
    EXPECT_TRUE(run_validate(arguments, false, out)) << out.str();
}

TEST(ValidationSuite, PassesOnTheExampleOfUniformWater) {
    ValidateArguments arguments;
    arguments.quiet = true;
    arguments.scene = std::string(UWVDB_SOURCE_DIR) + "/assets/scenes/uniform.yaml";
    arguments.overrides = {"camera.resolution=[12,7]"};
    std::ostringstream out;
    EXPECT_TRUE(run_validate(arguments, false, out)) << out.str();
}

}  // namespace
}  // namespace uw::test
