#pragma once

#include <optional>
#include <span>

namespace uw {

/// The smallest x in (0, limit] where the polynomial sum_i coefficients[i] x^i changes sign; empty
/// if there is none. Safe for any degree up to 16 and any finite coefficients: roots are bracketed
/// by those of the derivative and bisected, so none is stepped over.
std::optional<double> first_positive_root(std::span<const double> coefficients, double limit);

}  // namespace uw
