#pragma once

#include <functional>
#include <span>

#include "core/base/grid2d.h"
#include "core/forward/blur_kernel.h"
#include "core/forward/cosine_transform.h"
#include "core/forward/spline_grid.h"

namespace uw {

/// Sums images, each blurred with its own kernel. Images are extended beyond their borders by
/// endless reflection, without padding: the borders do not darken, and exactly as much light enters
/// across them as leaves. Only the sum is stored, however many images are summed. The result does
/// not depend on the number of threads.
///
/// Kernels that are wide do not need every pixel: the images are then spread to the nodes of a
/// spline, transformed there, and the sum is interpolated from them.
class MirroredBlur {
  public:
    /// Images of `width` times `height` pixels, blurred by way of nodes about `spacing` >= 1 pixels
    /// apart. Throws InputError if there is not enough memory.
    MirroredBlur(int width, int height, double spacing = 1);

    const SplineGrid& grid() const { return grid_; }

    /// Adds an image blurred with `kernel`, which must be made for images of this size.
    void add(const RowSource& image, const BlurKernel& kernel);
    /// The same for an image given at the nodes: its values there, or, if they are `means`,
    /// SplineGrid::means.
    void add_nodes(const RowSource& nodes, bool means, const BlurKernel& kernel);

    /// Whether anything was added since the last sum.
    bool any() const { return any_; }

    /// Passes the sum to `sink` and resets to zero.
    void finish(const RowSink& sink);
    /// The same as the coefficients of the spline, row by row of the nodes.
    void finish_nodes(const RowSink& sink);

  private:
    enum class Input { pixels, node_values, node_means };

    void add_columns(const BlurKernel& kernel, Input input);
    // Leaves the coefficients of the sum in `image_`, a column of nodes or of pixels in each.
    void finish_columns(bool pixels);

    SplineGrid grid_;
    CosineTransform along_rows_;
    CosineTransform along_columns_;
    std::vector<double> response_x_, response_y_;
    Grid2D<double> image_;     // the image added last, or the sum: nodes across
    Grid2D<double> spectrum_;  // of the sum; its rows are the image's columns
    bool any_ = false;
};

}  // namespace uw
