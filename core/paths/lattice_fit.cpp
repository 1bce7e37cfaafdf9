#include "core/paths/lattice_fit.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace uw {

bool CholeskyFactor::factor(std::span<const double> matrix, std::size_t size, double min_pivot) {
    size_ = size;
    lower_.assign(matrix.begin(), matrix.end());
    for (std::size_t i = 0; i < size; ++i) {
        double* row = &lower_[i * size];
        for (std::size_t j = 0; j <= i; ++j) {
            const double* other = &lower_[j * size];
            double sum = row[j];
            for (std::size_t k = 0; k < j; ++k) sum -= row[k] * other[k];
            if (i != j) {
                row[j] = sum / other[j];
                continue;
            }
            if (!(sum > min_pivot * row[i])) return false;
            row[i] = std::sqrt(sum);
        }
    }
    return true;
}

void CholeskyFactor::solve(std::span<double> x) const {
    for (std::size_t i = 0; i < size_; ++i) {
        for (std::size_t k = 0; k < i; ++k) x[i] -= lower_[i * size_ + k] * x[k];
        x[i] /= lower_[i * size_ + i];
    }
    for (std::size_t i = size_; i-- > 0;) {
        for (std::size_t k = i + 1; k < size_; ++k) x[i] -= lower_[k * size_ + i] * x[k];
        x[i] /= lower_[i * size_ + i];
    }
}

namespace {

constexpr int k_max_terms = 6;  // 1, x, y, x^2, xy, y^2
constexpr int k_min_radius_of_quadric = 2;
// The minimum pivot of the normal equations, relative to the diagonal.
constexpr double k_min_pivot = 1e-6;

using Terms = std::array<double, k_max_terms>;

// Calls visit(node, weight, terms) for the nodes nearer than radius + 1. The weight falls to 0
// there; x and y in the terms are in units of it.
template <class Visit>
void visit_near(std::span<const FitNode> nodes, int radius, const Visit& visit) {
    const double scale = 1.0 / (radius + 1);
    for (const FitNode& node : nodes) {
        const double x = node.dx * scale, y = node.dy * scale;
        const double near = 1 - x * x - y * y;
        if (near <= 0) return;
        visit(node, near * node.weight, Terms{1, x, y, x * x, x * y, y * y});
    }
}

}  // namespace

template <std::size_t k_terms>
bool LatticeFit::fit_polynomial(std::span<const FitNode> nodes, int radius) {
    // Local and of a fixed size, so that the compiler keeps it in registers.
    std::array<double, k_terms * k_terms> normal{};
    std::size_t used = 0;
    visit_near(nodes, radius, [&](const FitNode&, double kernel, const Terms& t) {
        ++used;
        for (std::size_t i = 0; i < k_terms; ++i) {
            const double weighted = kernel * t[i];
            for (std::size_t j = 0; j <= i; ++j) normal[i * k_terms + j] += weighted * t[j];
        }
    });
    if (used + 1 < 2 * k_terms || !cholesky_.factor(normal, k_terms, k_min_pivot)) return false;
    Terms solution{1};  // whose first term is the value at (0, 0)
    cholesky_.solve(std::span(solution).first(k_terms));
    weights_.resize(used);
    double amplification = 0;
    std::size_t n = 0;
    visit_near(nodes, radius, [&](const FitNode& node, double kernel, const Terms& t) {
        double weight = 0;
        for (std::size_t i = 0; i < k_terms; ++i) weight += solution[i] * t[i];
        weight *= kernel;
        weights_[n++] = {node.index, weight};
        amplification += weight * weight;
    });
    // Rejects an extrapolation that amplifies noise, in favour of a lower degree.
    return k_terms == 1 || amplification <= 1;
}

bool LatticeFit::fit(std::span<const FitNode> nodes, int radius) {
    return (radius >= k_min_radius_of_quadric && fit_polynomial<6>(nodes, radius)) ||
           fit_polynomial<3>(nodes, radius) || fit_polynomial<1>(nodes, radius);
}

}  // namespace uw
