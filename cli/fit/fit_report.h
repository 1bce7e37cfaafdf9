#pragma once

#include <string>
#include <vector>

#include "cli/pages/svg_plot.h"
#include "cli/report.h"
#include "fit/picture_residuals.h"
#include "fit/point_residuals.h"
#include "fit/robust_fit.h"

namespace uw {

/// What a fit found, for people and programs. Refers to both, which outlive it.
class FitReport {
  public:
    /// `pictures`: the observations, if they are of pictures; else null. `poses`: of the images, if
    /// they were found. `questions`: doubts about the input, in sentences.
    FitReport(const Observations& observations, const PictureResiduals* pictures,
              const FitResult& result, std::vector<FoundPose> poses = {},
              std::vector<std::string> questions = {});

    std::string printed(bool as_json) const;
    /// A self-contained page: values, undetermined unknowns, residuals.
    std::string page(const std::string& scene) const;
    /// A row per point or cell: its image, where it is there [pixels], its residuals, and whether
    /// it was left out.
    std::string csv() const;

  private:
    std::string summary_line() const;
    PlotFigure residual_figure() const;
    std::string picture_figures() const;

    const Observations& observations_;
    const PictureResiduals* pictures_;
    const FitResult& result_;
    std::vector<FoundPose> poses_;
    std::vector<std::string> doubts_;
};

/// What a fit cannot determine, or hardly can, in sentences with hints.
std::vector<std::string> doubts(const FitResult& result);

}  // namespace uw
