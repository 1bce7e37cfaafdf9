// ctest labels: analytic slow
// What `uwvdb validate` compares without a scene.
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

}  // namespace
}  // namespace uw::test
