#pragma once

#include <vector>

namespace uw {

/// A quantity sampled at ascending positions, linear in between.
struct SampledCurve {
    std::vector<double> x;  // strictly ascending, at least one
    std::vector<double> y;  // same length

    double first() const { return x.front(); }
    double last() const { return x.back(); }
    bool covers(double at) const { return at >= first() && at <= last(); }

    /// Linear interpolation; outside the samples the value at the nearer end is held; callers for
    /// whom that is wrong must check `covers` first.
    double value(double at) const;
};

}  // namespace uw
