#include "core/tables/sampled_curve.h"

#include <algorithm>

namespace uw {

double SampledCurve::value(double at) const {
    const auto above = std::upper_bound(x.begin(), x.end(), at);
    if (above == x.begin()) return y.front();
    if (above == x.end()) return y.back();
    const auto i = static_cast<std::size_t>(above - x.begin()) - 1;
    const double t = (at - x[i]) / (x[i + 1] - x[i]);
    return y[i] + t * (y[i + 1] - y[i]);
}

}  // namespace uw
