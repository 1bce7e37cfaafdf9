// ctest labels: unit analytic
#include "render/snow/snow_model.h"

#include <gtest/gtest.h>

#include "tests/support/phase_function_laws.h"

namespace uw {
namespace {

TEST(LambertSphere, ObeysTheLaws) {
    test::expect_phase_function_laws(LambertSphere{});
}

/// Integrated over the half of a sphere that is lit and seen: a patch of normal n, lit from l and
/// seen from v, sends (l.n)(v.n)/pi towards v.
TEST(LambertSphere, IsTheLightOfADiffuseSphere) {
    constexpr int k_steps = 400;
    for (const double psi : {std::numbers::pi, 2.5, 1.5, 0.6}) {
        // The phase angle between lamp and camera is pi - psi.
        const double l_x = std::sin(std::numbers::pi - psi), l_z = std::cos(std::numbers::pi - psi);
        double sum = 0;
        for (int i = 0; i < k_steps; ++i)
            for (int j = 0; j < 2 * k_steps; ++j) {
                const double z = (i + 0.5) / k_steps;  // towards the camera
                const double angle = (j + 0.5) * std::numbers::pi / k_steps;
                const double lit = l_x * std::sqrt(1 - z * z) * std::cos(angle) + l_z * z;
                if (lit > 0) sum += lit * z / std::numbers::pi;
            }
        sum *= std::numbers::pi / k_steps / k_steps;
        // Per cross section, which is pi.
        EXPECT_NEAR(sum / std::numbers::pi, LambertSphere::at(psi), 1e-4) << psi;
    }
}

}  // namespace
}  // namespace uw
