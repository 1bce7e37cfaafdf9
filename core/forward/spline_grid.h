#pragma once

#include <array>
#include <functional>
#include <span>

#include "core/base/grid2d.h"
#include "core/forward/spline_line.h"

namespace uw {

/// Writes row `y` of an image into a row of zeros; returns false if it remains zero. Called from
/// any thread, once per row.
using RowSource = std::function<bool(int y, std::span<double> row)>;

/// Receives row `y` of an image. Called from any thread, once per row.
using RowSink = std::function<void(int y, std::span<const double> row)>;

/// The nodes of a spline on the pixels of an image: SplineLine along both axes.
class SplineGrid {
  public:
    /// Nodes about `spacing` >= 1 pixels apart.
    SplineGrid(int width, int height, double spacing)
        : width_(width),
          height_(height),
          x_(width, SplineLine::node_count(width, spacing)),
          y_(height, SplineLine::node_count(height, spacing)) {}

    int width() const { return width_; }
    int height() const { return height_; }
    int columns() const { return x_.nodes(); }
    int rows() const { return y_.nodes(); }
    const SplineLine& x() const { return x_; }
    const SplineLine& y() const { return y_; }

    /// The means of an image about each node, weighted as SplineLine::spread does. The result does
    /// not depend on the number of threads.
    void means(const RowSource& pixels, Grid2D<float>& nodes) const;
    /// The values at the nodes of the spline with these coefficients.
    void values(const Grid2D<float>& coefficients, Grid2D<float>& nodes) const;
    /// Passes its values at the pixels to `sink`, row by row, from any thread.
    void interpolate(const Grid2D<float>& coefficients, const RowSink& sink) const;
    /// The values at pixel (x, y) of two splines.
    std::array<float, 2> at(const Grid2D<float>& first, const Grid2D<float>& second, int x,
                            int y) const;

  private:
    int width_, height_;
    SplineLine x_, y_;
};

}  // namespace uw
