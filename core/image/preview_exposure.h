#pragma once

#include <optional>

#include "core/image/film.h"

namespace uw {

/// The factor that brings the brighter parts of the film to a luminance of 0.8: the 99th percentile
/// over the pixels with a ray (alpha > 0) and finite values that show no lamp, or the brightest
/// pixel if fewer than 1 % are not black. Empty if all are black, which the caller should report.
std::optional<double> automatic_exposure(const Film& film);

/// How the exposure of the previews of a run's images is chosen.
struct PreviewExposure {
    enum class Kind {
        automatic,  // each by its own
        first,      // all by that of the first image that is not black
        fixed
    };
    Kind kind = Kind::automatic;
    double factor = 1;  // of `fixed`
};

/// Chooses the exposures of a run's images, one after the other.
class RunExposure {
  public:
    explicit RunExposure(const PreviewExposure& wanted);

    /// The one exposure of all images; none: each has its own, or it is not known yet.
    const std::optional<double>& of_all() const { return of_all_; }
    /// Where it is the first image's, and that was rendered before. Does nothing otherwise.
    void keep(double first);
    /// The exposure of an image; none: its own.
    std::optional<double> of(const Film& film);

  private:
    PreviewExposure::Kind kind_;
    std::optional<double> of_all_;
};

}  // namespace uw
