#pragma once

#include <vector>

#include "core/scene/forward_scatter_desc.h"

namespace uw {

/// A few widths between which kernels are interpolated: the kernel of any width from the least to
/// the greatest is a sum of those of up to four neighbouring widths, by a cubic in the logarithm.
/// Compared with the exact kernel it misplaces less than 0.25 % of the light.
class WidthLadder {
  public:
    /// No widths.
    WidthLadder() = default;
    /// For widths s from `least` to `greatest` [pixels], as BlurWidth. If they are the same, the
    /// only width is exactly this.
    WidthLadder(ForwardScatterDesc::Shape shape, double least, double greatest);

    const std::vector<double>& widths() const { return widths_; }

    /// The place of a width on the ladder: 0 for the first, counted in steps.
    double place(double width) const;
    /// The share of the kernel of width `step` in that of the width at `place`; 0 unless `place` is
    /// close.
    double weight(int step, double place) const {
        const int first = first_step(place);
        return step < first || step >= first + neighbours_
                   ? 0
                   : polynomial(step - first, place - first);
    }

  private:
    int first_step(double place) const;
    double polynomial(int n, double t) const;

    double offset_ = 0;
    double begin_ = 0, per_step_ = 1;  // of the logarithm
    int neighbours_ = 1;               // in an interpolation
    std::vector<double> widths_;
};

}  // namespace uw
