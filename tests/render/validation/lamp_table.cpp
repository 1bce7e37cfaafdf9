// ctest labels: statistical
#include "render/validation/light_trial.h"

#include <gtest/gtest.h>

namespace uw::test {
namespace {

TEST(LampTable, IsWhatLightPathsFindOrderByOrder) {
    const LightValidation result = validate_by_table(lamp_table().subspan(1, 1), {});
    EXPECT_TRUE(result.passed());
    EXPECT_EQ(result.checks.size(), 5U);
}

TEST(LampTable, FailsInTheOrderThatIsWrong) {
    LampTableRow row = lamp_table()[1];
    row.orders[1] *= 1.01;
    const LightValidation result = validate_by_table(std::span(&row, 1), {});
    EXPECT_FALSE(result.passed());
    for (const LightCheck& check : result.checks)
        EXPECT_EQ(check.passed(), check.light != "order 2, 1 m, 5 degrees") << check.light;
}

}  // namespace
}  // namespace uw::test
