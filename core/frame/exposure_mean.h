#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "core/base/grid2d.h"
#include "core/colour/colour.h"
#include "core/frame/pixel_layers.h"
#include "core/image/film.h"
#include "core/image/layers.h"

namespace uw {

/// The image of an exposure as the mean over images of its parts. Light is averaged, and sums of
/// layers stay sums to the bit; the transmittance is the mean over what hits a surface. Layers of
/// the exposure's middle are left alone.
class ExposureMean {
  public:
    /// The share of a row's exposure that a part has, 0 to 1; those of all parts add up to 1.
    using RowShare = std::function<double(int row)>;

    /// Adds to `mean`, whose values are 0; it outlives this object, as do `plan` and `colour`.
    /// `terms`: of the images. Throws InputError if there is not enough memory.
    ExposureMean(const LayerPlan& plan, const LightTerms& terms, const BandColour& colour,
                 Film& mean);

    /// Includes the image of a part: with the same channels, and of the window all rows that have
    /// a share.
    void add(const Film& part, const RowShare& share);

    /// After the last part.
    void finish();

  private:
    void add_pixel(std::span<const float> part, float share, float share_so_far,
                   std::span<float> mean) const;
    void add_transmittance(std::span<const float> part, float share, std::span<float> mean,
                           float& on_surface) const;

    const LayerPlan& plan_;
    LightTerms terms_;
    const BandColour& colour_;
    Film& mean_;
    std::vector<std::size_t> channels_;  // that are means
    std::vector<float> shares_;          // so far, of each row of the window
    Grid2D<float> on_surface_;           // share of the exposure that shows a surface
};

}  // namespace uw
