#pragma once

#include <array>
#include <span>

namespace uw {

/// One node of a quadrature rule on [0, 1]; weights sum to 1.
struct QuadratureNode {
    double position;
    double weight;
};

/// Gauss-Legendre rules on [0, 1] with `count` = 2..4 nodes: exact for polynomials of degree
/// 2 count - 1 (Abramowitz & Stegun, table 25.4).
std::span<const QuadratureNode> gauss_legendre(int count);

}  // namespace uw
