#include "core/base/numerics.h"

#include <cassert>

namespace uw {

UWVDB_VECTOR_CLONES void exp_of_minus(std::span<double> x) {
    for (double& value : x) value = exp_of_minus(value);
}

namespace {

constexpr QuadratureNode node(double x, double w) {
    return {0.5 * (1.0 + x), 0.5 * w};
}

constexpr std::array k_two = {node(-0.57735026918962576, 1.0), node(0.57735026918962576, 1.0)};
constexpr std::array k_three = {node(-0.77459666924148338, 0.55555555555555556),
                                node(0.0, 0.88888888888888889),
                                node(0.77459666924148338, 0.55555555555555556)};
constexpr std::array k_four = {node(-0.86113631159405258, 0.34785484513745386),
                               node(-0.33998104358485626, 0.65214515486254614),
                               node(0.33998104358485626, 0.65214515486254614),
                               node(0.86113631159405258, 0.34785484513745386)};

}  // namespace

std::span<const QuadratureNode> gauss_legendre(int count) {
    assert(count >= 2 && count <= 4);
    if (count == 2) return k_two;
    if (count == 3) return k_three;
    return k_four;
}

}  // namespace uw
