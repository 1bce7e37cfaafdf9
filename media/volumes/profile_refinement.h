#pragma once

#include <functional>
#include <span>
#include <vector>

#include "core/optics/concentration_field.h"

namespace uw {

/// Makes a coarse profile as fine as a tolerance requires: intervals are halved where a sample
/// halfway, or halfway through the next interval, differs from linear interpolation by more than
/// the tolerance. The sample stays, so that the error left is about a quarter of the one allowed
/// where concentrations are smooth. Sheets as thin as half an interval are not missed. Reused
/// between rays.
class ProfileRefinement {
  public:
    /// Writes the concentrations at the distances `s`, one per constituent each.
    using Sample = std::function<void(std::span<const double> s, std::vector<double>& values)>;

    /// Refines `profile`, whose knots and concentrations are given, and computes its columns.
    /// `least[i]`: interval i is not split into any shorter than about this [m]; infinite where
    /// nothing varies.
    void run(const DepthTolerance& tolerance, const Sample& sample, std::vector<double>& least,
             ConcentrationProfile& profile);

  private:
    void merge(const DepthTolerance& tolerance, std::vector<double>& least,
               ConcentrationProfile& profile);
    void find_refused(const DepthTolerance& tolerance);
    bool confirmed(const DepthTolerance& tolerance, std::size_t interval, const double* middle);

    std::vector<char> open_, open_before_;  // intervals that a sample halfway must confirm
    std::vector<char> refused_;             // by interval, one more at either end
    std::vector<double> middles_, values_;  // their midpoints, and the concentrations there
    std::vector<double> error_;
    ConcentrationProfile before_;
    std::vector<double> least_before_;
};

}  // namespace uw
