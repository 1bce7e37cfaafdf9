// ctest labels: unit analytic
#include "core/base/numerics.h"

#include <gtest/gtest.h>

#include <cmath>

namespace uw {
namespace {

double integral_of_power(int nodes, int power) {
    double sum = 0;
    for (const QuadratureNode& node : gauss_legendre(nodes))
        sum += node.weight * std::pow(node.position, power);
    return sum;
}

TEST(Quadrature, IsExactForPolynomialsOfTwiceTheNodesLessOne) {
    for (int nodes = 2; nodes <= 4; ++nodes) {
        EXPECT_EQ(gauss_legendre(nodes).size(), static_cast<std::size_t>(nodes));
        for (int power = 0; power < 2 * nodes; ++power)
            EXPECT_NEAR(integral_of_power(nodes, power), 1.0 / (power + 1), 1e-15)
                << nodes << " nodes, power " << power;
    }
}

TEST(Quadrature, ErrsByTheKnownTermOneDegreeHigher) {
    // (n!)^4 / ((2n + 1) ((2n)!)^2) for n nodes and x^(2n).
    EXPECT_NEAR(1.0 / 5 - integral_of_power(2, 4), 1.0 / 180, 1e-15);
    EXPECT_NEAR(1.0 / 7 - integral_of_power(3, 6), 1.0 / 2800, 1e-15);
    EXPECT_NEAR(1.0 / 9 - integral_of_power(4, 8), 1.0 / 44100, 1e-15);
}

TEST(Quadrature, NodesAscendInsideAndMirrorEachOther) {
    for (int count = 2; count <= 4; ++count) {
        const auto nodes = gauss_legendre(count);
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            const QuadratureNode& mirror = nodes[nodes.size() - 1 - i];
            EXPECT_NEAR(nodes[i].position, 1 - mirror.position, 1e-16);
            EXPECT_EQ(nodes[i].weight, mirror.weight);
            EXPECT_GT(nodes[i].position, i == 0 ? 0 : nodes[i - 1].position);
            EXPECT_LT(nodes[i].position, 1);
        }
    }
}

}  // namespace
}  // namespace uw
