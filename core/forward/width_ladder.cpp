#include "core/forward/width_ladder.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace uw {

namespace {

/// The ratios of offset + s between neighbouring widths s [pixels] at which interpolation between
/// two, three, or four of them misplaces less than 0.25 % of the light.
struct LadderRule {
    std::array<double, 3> ratios;
    double offset;
};

LadderRule ladder_rule(ForwardScatterDesc::Shape shape) {
    if (shape == ForwardScatterDesc::Shape::exponential) return {{1.2, 1.4, 1.5}, 0.1};
    return {{1.1, 1.18, 1.22}, 0.06};
}

}  // namespace

WidthLadder::WidthLadder(ForwardScatterDesc::Shape shape, double least, double greatest) {
    const LadderRule rule = ladder_rule(shape);
    offset_ = rule.offset;
    begin_ = std::log(least + offset_);
    const double extent = std::log(greatest + offset_) - begin_;
    widths_.push_back(least);
    if (!(extent > 1e-9)) return;
    int steps = 1;
    while (extent > steps * std::log(rule.ratios[static_cast<std::size_t>(std::min(steps, 3)) - 1]))
        ++steps;
    neighbours_ = std::min(steps, 3) + 1;
    for (int n = 0; n < neighbours_; ++n)
        for (int i = 0; i < neighbours_; ++i)
            if (i != n) inverse_[static_cast<std::size_t>(n)] /= n - i;
    per_step_ = extent / steps;
    for (int i = 1; i < steps; ++i) widths_.push_back(std::exp(begin_ + per_step_ * i) - offset_);
    widths_.push_back(greatest);
}

double WidthLadder::place(double width) const {
    if (widths_.size() == 1) return 0;
    const double last = static_cast<double>(widths_.size()) - 1;
    return std::clamp((std::log(width + offset_) - begin_) / per_step_, 0.0, last);
}

}  // namespace uw
