#pragma once

#include <string>
#include <vector>

#include "cli/report.h"
#include "fit/point_residuals.h"
#include "fit/robust_fit.h"

namespace uw {

/// What a fit found, for people and programs. Refers to both, which outlive it.
class FitReport {
  public:
    FitReport(const PointResiduals& points, const FitResult& result);

    std::string printed(bool as_json) const;
    /// A self-contained page: values, what cannot be told, residuals.
    std::string page(const std::string& scene) const;
    /// A row per point: image, x, y, z, u, v, the residual in pixels, and whether it was left out.
    std::string csv() const;

  private:
    const PointResiduals& points_;
    const FitResult& result_;
};

/// What a fit cannot tell, and what is nearly so, in sentences with the mend.
std::vector<std::string> doubts(const FitResult& result);

}  // namespace uw
