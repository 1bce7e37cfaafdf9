#pragma once

#include <optional>

#include "core/scene/sensor_desc.h"
#include "core/tables/sampled_curve.h"

namespace uw {

/// How a camera encodes values, 0 to 1, before it stores them.
class ResponseCurve {
  public:
    /// Throws InputError for a table whose values are not between 0 and 1 or do not ascend; IoError
    /// if it cannot be read.
    explicit ResponseCurve(const ResponseCurveDesc& desc);

    /// Of any value; those outside 0..1 become 0 or 1 first, NaN 0.
    double operator()(double value) const;

  private:
    ResponseCurveDesc desc_;
    std::optional<SampledCurve> table_;
};

}  // namespace uw
