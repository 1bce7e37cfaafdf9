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
constexpr std::array<int, 5> k_fit_radii{0, 1, 2, 4, LatticeFit::k_max_radius};
// A wider fit is rejected if it differs from a narrower one by more than so many standard
// deviations of that. Low, so that halos of lamps and edges of plumes are kept, and often wrong:
// callers let several fits decide together.
constexpr double k_agreement = 1.5;
// A fit is not widened further if its standard deviation is below this, relative to the tolerance.
constexpr double k_quiet = 0.5;
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
bool LatticeFit::try_polynomial(std::span<const FitNode> nodes, int radius) {
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
    tried_.resize(used);
    double value = 0, variance = 0, amplification = 0;
    std::size_t n = 0;
    visit_near(nodes, radius, [&](const FitNode& node, double kernel, const Terms& t) {
        double weight = 0;
        for (std::size_t i = 0; i < k_terms; ++i) weight += solution[i] * t[i];
        weight *= kernel;
        tried_[n++] = {node.index, weight};
        value += weight * node.value;
        variance += weight * weight * node.variance;
        amplification += weight * weight;
    });
    tried_value_ = value;
    tried_variance_ = variance;
    // Rejects an extrapolation that amplifies noise, in favour of a lower degree.
    return k_terms == 1 || amplification <= 1;
}

bool LatticeFit::try_within(std::span<const FitNode> nodes, int radius) {
    return (radius >= 2 && try_polynomial<6>(nodes, radius)) || try_polynomial<3>(nodes, radius) ||
           try_polynomial<1>(nodes, radius);
}

void LatticeFit::accept_tried(int radius) {
    narrower_.swap(weights_);
    weights_.swap(tried_);
    variance_ = tried_variance_;
    radius_ = radius;
}

void LatticeFit::clear() {
    weights_.clear();
    narrower_.clear();
    variance_ = 0;
    radius_ = -1;
}

void LatticeFit::fit(std::span<const FitNode> nodes, double tolerance) {
    clear();
    struct Accepted {
        double value, deviation;
    };
    std::array<Accepted, k_fit_radii.size()> accepted{};
    std::size_t count = 0;
    for (const int radius : k_fit_radii) {
        if (!try_within(nodes, radius)) continue;
        const bool agrees =
            std::all_of(accepted.begin(), accepted.begin() + static_cast<std::ptrdiff_t>(count),
                        [&](const Accepted& narrower) {
                            return std::abs(tried_value_ - narrower.value) <=
                                   k_agreement * narrower.deviation + tolerance;
                        });
        if (count > 0 && !agrees) break;
        accepted[count++] = {tried_value_, std::sqrt(tried_variance_)};
        accept_tried(radius);
        if (std::sqrt(variance_) < k_quiet * tolerance) break;
    }
}

void LatticeFit::fit_within(std::span<const FitNode> nodes, int radius) {
    clear();
    const auto* wanted = std::ranges::lower_bound(k_fit_radii, radius);
    if (wanted != k_fit_radii.begin() && try_within(nodes, *(wanted - 1)))
        accept_tried(*(wanted - 1));
    if (try_within(nodes, *wanted)) accept_tried(*wanted);
}

}  // namespace uw
