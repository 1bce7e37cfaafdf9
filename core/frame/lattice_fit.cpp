#include "core/frame/lattice_fit.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace uw {

namespace {

constexpr int k_most_terms = 6;  // 1, x, y, x^2, xy, y^2
constexpr std::array<int, 5> k_reaches{0, 1, 2, 4, LatticeFit::k_reach};
// In units of a narrower fit's standard deviation: a wider fit that differs by more follows the
// light less well.
constexpr double k_agreement = 1.5;

using Terms = std::array<double, k_most_terms>;
using Matrix = std::array<Terms, k_most_terms>;

Terms terms_at(double x, double y) {
    return {1, x, y, x * x, x * y, y * y};
}

// Solves matrix * solution = (1, 0, 0, ...) by Cholesky's method; false if it is nearly singular.
bool solve_for_value(Matrix& a, int count, Terms& solution) {
    const auto n = static_cast<std::size_t>(count);
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j <= i; ++j) {
            double sum = a[i][j];
            for (std::size_t k = 0; k < j; ++k) sum -= a[i][k] * a[j][k];
            if (i != j) {
                a[i][j] = sum / a[j][j];
                continue;
            }
            if (!(sum > 1e-6 * a[i][i])) return false;
            a[i][i] = std::sqrt(sum);
        }
    }
    for (std::size_t i = 0; i < n; ++i) {
        double sum = i == 0 ? 1 : 0;
        for (std::size_t k = 0; k < i; ++k) sum -= a[i][k] * solution[k];
        solution[i] = sum / a[i][i];
    }
    for (std::size_t i = n; i-- > 0;) {
        double sum = solution[i];
        for (std::size_t k = i + 1; k < n; ++k) sum -= a[k][i] * solution[k];
        solution[i] = sum / a[i][i];
    }
    return true;
}

}  // namespace

bool LatticeFit::fit_within(std::span<const FitNode> nodes, int reach, int terms) {
    Matrix normal{};
    tried_.clear();
    const double scale = 1.0 / (reach + 1);
    int used = 0;
    for (const FitNode& node : nodes) {
        const double x = node.dx * scale, y = node.dy * scale;
        const double rest = 1 - x * x - y * y;
        if (rest <= 0) continue;
        ++used;
        const Terms t = terms_at(x, y);
        for (std::size_t i = 0; i < static_cast<std::size_t>(terms); ++i)
            for (std::size_t j = 0; j <= i; ++j) normal[i][j] += rest * t[i] * t[j];
    }
    Terms solution{};
    if (used < 2 * terms - 1 || !solve_for_value(normal, terms, solution)) return false;
    tried_value_ = tried_variance_ = 0;
    double amplification = 0;
    for (const FitNode& node : nodes) {
        const double x = node.dx * scale, y = node.dy * scale;
        const double rest = 1 - x * x - y * y;
        if (rest <= 0) continue;
        const Terms t = terms_at(x, y);
        double weight = 0;
        for (std::size_t i = 0; i < static_cast<std::size_t>(terms); ++i)
            weight += solution[i] * t[i];
        weight *= rest;
        tried_.push_back({node.index, weight});
        tried_value_ += weight * node.value;
        tried_variance_ += weight * weight * node.variance;
        amplification += weight * weight;
    }
    // An extrapolation that makes noise greater is left to a lower degree.
    return terms == 1 || amplification <= 1;
}

std::span<const FitWeight> LatticeFit::fit(std::span<const FitNode> nodes, double tolerance) {
    weights_.clear();
    variance_ = 0;
    struct Accepted {
        double value, deviation;
    };
    std::array<Accepted, k_reaches.size()> accepted{};
    std::size_t count = 0;
    for (const int reach : k_reaches) {
        // Of the highest degree that the nodes determine.
        bool found = false;
        for (const int terms : {6, 3, 1}) {
            if (reach < 2 && terms == 6) continue;
            found = fit_within(nodes, reach, terms);
            if (found) break;
        }
        if (!found) continue;
        const bool agrees =
            std::all_of(accepted.begin(), accepted.begin() + static_cast<std::ptrdiff_t>(count),
                        [&](const Accepted& narrower) {
                            return std::abs(tried_value_ - narrower.value) <=
                                   k_agreement * narrower.deviation + tolerance;
                        });
        if (count > 0 && !agrees) break;
        accepted[count++] = {tried_value_, std::sqrt(tried_variance_)};
        weights_.swap(tried_);
        variance_ = tried_variance_;
    }
    return weights_;
}

}  // namespace uw
