#include "core/paths/parallel_stretch.h"

#include <algorithm>
#include <cmath>

namespace uw {

namespace {

// Over a smaller change the light counts as even.
constexpr double k_even_depth = 1e-6;

}  // namespace

double ParallelStretch::effective_length() const {
    const double depth = rate_ * lit_.length();
    return std::abs(depth) < k_even_depth ? lit_.length() : -std::expm1(-depth) / rate_;
}

double ParallelStretch::draw(double share) const {
    const double depth = rate_ * lit_.length();
    const double s = std::abs(depth) < k_even_depth
                         ? share * lit_.length()
                         : -std::log1p(share * std::expm1(-depth)) / rate_;
    return lit_.begin + std::clamp(s, 0.0, lit_.length());
}

double ParallelStretch::density(double s) const {
    const double depth = rate_ * lit_.length();
    if (std::abs(depth) < k_even_depth) return 1 / lit_.length();
    return std::exp(-rate_ * (s - lit_.begin)) / effective_length();
}

}  // namespace uw
