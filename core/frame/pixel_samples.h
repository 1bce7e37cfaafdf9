#pragma once

#include "core/base/ray_source.h"

namespace uw {

/// The samples of every pixel.
struct PixelSamples {
    int count = 1;  ///< >= 1; a single one lies at the pixel's centre
    /// Of a part of an exposure, whose parts cover the pixel together: this many in all of them,
    /// and how many in those before. 0: the image is no part.
    int total = 0, first = 0;
};

/// A place in a pixel, from its corner [pixels].
struct ImageOffset {
    double x, y;
};

/// Where in a pixel, through which point of the aperture and when its samples are taken: evenly in
/// each, and in all of them together. Places are the same in all pixels, points and moments differ,
/// as the same ones in all would show as many sharp images.
class PixelSampling {
  public:
    /// Of pixel (x, y).
    PixelSampling(const PixelSamples& samples, int x, int y);

    /// Of sample `i` < count. Hammersley points: every sample has its own row and column of the
    /// pixel, a single one the centre. Of a part of an exposure, whose samples are in the order of
    /// time, Halton points, of which those that follow each other cover the pixel, too.
    ImageOffset offset(int i) const;
    AperturePoint aperture(int i) const;
    /// Of the exposure, or of its part, 0 to 1: one in each of `count` equal spans.
    double moment(int i) const { return (i + shift_moment_) / samples_.count; }

  private:
    PixelSamples samples_;
    double shift_a_, shift_b_, shift_moment_;
};

}  // namespace uw
