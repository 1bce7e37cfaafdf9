#include "core/optics/depth_tolerance.h"

#include <cmath>

#include "core/base/fast_exp.h"
#include "core/optics/optical_depth.h"

namespace uw {

DepthTolerance::DepthTolerance(const Medium& medium, double optical_depth)
    : optical_depth_(optical_depth) {
    const AttenuationTable attenuation(medium);
    const auto bands = static_cast<std::size_t>(attenuation.band_count);
    least_uniform_ = attenuation.uniform.least(bands);
    for (const Spectrum& per_unit : attenuation.constituents) {
        least_per_unit_.push_back(per_unit.least(bands));
        most_per_unit_.push_back(per_unit.greatest(bands));
    }
}

bool DepthTolerance::allows(std::span<const double> error, double length,
                            std::span<const double> before) const {
    double depth = 0;
    for (std::size_t k = 0; k < most_per_unit_.size(); ++k)
        depth += most_per_unit_[k] * std::abs(error[k]);
    return depth <= optical_depth_ ||
           depth * exp_of_minus(least_depth(length, before)) <= optical_depth_;
}

double DepthTolerance::least_depth(double length, std::span<const double> columns) const {
    double depth = least_uniform_ * length;
    for (std::size_t k = 0; k < least_per_unit_.size(); ++k)
        depth += least_per_unit_[k] * columns[k];
    return depth;
}

}  // namespace uw
