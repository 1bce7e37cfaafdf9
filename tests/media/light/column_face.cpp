// ctest labels: unit
#include "media/light/column_map.h"

#include <gtest/gtest.h>

namespace uw::test {
namespace {

constexpr int k_width = 5, k_height = 4;

/// Concentration of the ray through texel (u, v), the same all along it.
double concentration(double u, double v) {
    return 1 + u + 10 * v;
}

ColumnFace linear_face() {
    return {k_width,
            k_height,
            1,
            0.5,
            1,
            DepthTolerance(),
            [](int u, int v, ConcentrationProfile& profile) {
                profile.constituent_count = 1;
                profile.s = {0, 2, 4};
                profile.concentration.assign(3, concentration(u, v));
                profile.integrate();
            }};
}

TEST(ColumnFace, IsLinearBetweenRaysUpToTheRectanglesEdges) {
    const ColumnFace face = linear_face();
    for (double u = 0; u <= k_width - 1; u += 0.25) {
        for (double v = 0; v <= k_height - 1; v += 0.25) {
            for (const double distance : {0.3, 2.0, 3.9, 7.0}) {
                double column = 100;
                face.add(u, v, distance, {&column, 1});
                // Samples are floats.
                EXPECT_NEAR(column - 100, concentration(u, v) * std::min(distance, 4.0), 1e-4)
                    << u << " " << v;
            }
        }
    }
}

TEST(ColumnFace, IsNothingOutsideTheRectangle) {
    const ColumnFace face = linear_face();
    for (const auto& [u, v] : {std::pair{-0.01, 1.0},
                               {1.0, -0.01},
                               {k_width - 0.99, 1.0},
                               {1.0, k_height - 0.99},
                               {-1.0, -1.0}}) {
        double column = 0;
        face.add(u, v, 3, {&column, 1});
        EXPECT_EQ(column, 0);
        EXPECT_EQ(face.spacing(u, v), 0);
    }
    EXPECT_EQ(face.spacing(0, 0), 1);
}

}  // namespace
}  // namespace uw::test
