#pragma once

#include <functional>
#include <span>

#include "core/base/grid2d.h"
#include "core/forward/blur_kernel.h"
#include "core/forward/cosine_transform.h"

namespace uw {

/// Sums images, each blurred with its own kernel. Images are extended beyond their borders by
/// endless reflection, without padding: the borders do not darken, and exactly as much light enters
/// across them as leaves. Only the sum is stored: two images of doubles, however many images are
/// summed. The result does not depend on the number of threads.
class MirroredBlur {
  public:
    /// Images of `width` times `height` pixels. Throws InputError if there is not enough memory.
    MirroredBlur(int width, int height);

    /// Writes row `y` of an image into a row of zeros; returns false if it remains zero. Called
    /// from any thread, once per row.
    using RowSource = std::function<bool(int y, std::span<double> row)>;
    /// Adds an image blurred with `kernel`, which must be made for images of this size.
    void add(const RowSource& image, const BlurKernel& kernel);

    /// Receives row `y` of the sum. Called from any thread, once per row.
    using RowSink = std::function<void(int y, std::span<const double> row)>;
    /// Passes the sum to `sink` and resets to zero.
    void finish(const RowSink& sink);

  private:
    void add_columns(const BlurKernel& kernel);

    int width_;
    int height_;
    CosineTransform along_rows_;
    CosineTransform along_columns_;
    Grid2D<double> image_;     // the image added last, or the sum
    Grid2D<double> spectrum_;  // of the sum; its rows are the image's columns
    bool any_ = false;
};

}  // namespace uw
