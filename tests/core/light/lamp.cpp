// ctest labels: unit analytic
#include "core/light/lamp.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>

namespace uw::test {
namespace {

Lamp lamp_with(LampProfile profile) {
    return {"lamp", {0.3, -0.2, 0.5}, std::move(profile), Spectrum{}};
}

TEST(Lamp, SaysWhatItsProfileIs) {
    EXPECT_EQ(lamp_with(IsotropicProfile{}).profile_name(), "isotropic");
    EXPECT_EQ(lamp_with(SpotProfile({60}, {})).profile_name(), "spot");
    EXPECT_EQ(lamp_with(CosineProfile({60}, {})).profile_name(), "cosine");
}

TEST(Lamp, WithoutABeamShinesOnAllOfARay) {
    const Ray ray{{0, 0, 0}, {0, 0, -1}};
    for (const Lamp& lamp : {lamp_with(IsotropicProfile{}), lamp_with(CosineProfile({60}, {}))}) {
        EXPECT_EQ(lamp.beam(ray, {1, 3}).begin, 1);
        EXPECT_EQ(lamp.beam(ray, {1, 3}).end, 3);
    }
}

TEST(Lamp, BeamEndsWhereTheConeIsCrossed) {
    // Along z from (0.3, -0.2, 0.5), 40 degrees to both sides, hard.
    const Lamp lamp = lamp_with(SpotProfile({80}, {}));
    const double half_width = std::tan(40 * std::numbers::pi / 180);
    const Ray across{{-5, -0.2, 1.5}, {1, 0, 0}};  // 1 m before the lamp
    const Interval lit = lamp.beam(across, {0, 20});
    EXPECT_NEAR(lit.begin, 5.3 - half_width, 1e-9);
    EXPECT_NEAR(lit.end, 5.3 + half_width, 1e-9);
    EXPECT_NEAR(lamp.beam(across, {5, 5.5}).length(), 0.5, 1e-12);  // all of it within
    const Ray behind{{-5, -0.2, -0.5}, {1, 0, 0}};
    EXPECT_EQ(lamp.beam(behind, {0, 20}).length(), 0);
}

}  // namespace
}  // namespace uw::test
