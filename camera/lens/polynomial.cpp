#include "camera/lens/polynomial.h"

#include <cstddef>
#include <vector>

namespace uw {
namespace {

double evaluate(std::span<const double> c, double x) {
    double sum = 0;
    for (std::size_t i = c.size(); i-- > 0;) sum = sum * x + c[i];
    return sum;
}

/// The sign change between `low` and `high`, to the last bit.
double bisect(std::span<const double> c, double low, double high) {
    const bool low_positive = evaluate(c, low) > 0;
    for (;;) {
        const double middle = low + 0.5 * (high - low);
        if (middle <= low || middle >= high) return high;
        ((evaluate(c, middle) > 0) == low_positive ? low : high) = middle;
    }
}

/// Every sign change in (0, limit], ascending. Between two sign changes of its derivative the
/// polynomial is monotone, so it changes sign there at most once.
std::vector<double> sign_changes(std::span<const double> c, double limit) {
    if (c.size() < 2) return {};
    std::vector<double> derivative;
    for (std::size_t i = 1; i < c.size(); ++i) derivative.push_back(static_cast<double>(i) * c[i]);
    std::vector<double> ends = sign_changes(derivative, limit);
    ends.push_back(limit);

    std::vector<double> roots;
    double low = 0;
    for (const double high : ends) {
        if ((evaluate(c, low) > 0) != (evaluate(c, high) > 0))
            roots.push_back(bisect(c, low, high));
        low = high;
    }
    return roots;
}

}  // namespace

std::optional<double> first_positive_root(std::span<const double> coefficients, double limit) {
    const std::vector<double> roots = sign_changes(coefficients, limit);
    if (roots.empty()) return std::nullopt;
    return roots.front();
}

}  // namespace uw
