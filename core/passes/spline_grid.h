#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "core/base/grid2d.h"

namespace uw {

/// A line of pixels and the nodes of a quintic B-spline on it, both at the centres of equal parts
/// of the line, both extended by reflection at its ends. A line with as many nodes as pixels is its
/// own spline.
///
/// The cosine transform of what `spread` writes is that of the pixels times `response`, and the
/// spectrum of what `interpolate` writes is that of the coefficients times `response`, but for
/// aliases: those of frequencies near whole numbers of cycles per node, which the spline
/// suppresses, and those close to half a cycle, which are left to a kernel without such
/// frequencies.
class SplineLine {
  public:
    /// Precondition: 1 <= nodes <= pixels.
    SplineLine(int pixels, int nodes);

    int nodes() const { return nodes_; }
    /// Whether pixels and nodes are the same.
    bool is_identity() const { return taps_.empty(); }
    /// Calls `tap(node, weight)` for each node that pixel `i` has a share in.
    template <class Tap>
    void for_each_tap(int i, const Tap& tap) const {
        if (is_identity()) {
            tap(i, 1.0);
            return;
        }
        const Taps& taps = taps_[static_cast<std::size_t>(i)];
        for (std::size_t n = 0; n < k_taps; ++n) tap(taps.nodes[n], taps.weights[n]);
    }
    /// The same for the value of the spline at node `i`.
    template <class Tap>
    void for_each_node_tap(int i, const Tap& tap) const {
        if (is_identity()) {
            tap(i, 1.0);
            return;
        }
        for (std::size_t n = 0; n < k_at_nodes.size(); ++n)
            tap(reflected(i + static_cast<int>(n) - 2), k_at_nodes[n]);
    }

    /// Adds each pixel to the nodes around it.
    void spread(std::span<const double> pixels, std::span<double> nodes) const;
    /// The values at the pixels of the spline with the coefficients `nodes`.
    void interpolate(std::span<const double> nodes, std::span<double> pixels) const;
    /// The spline's transform at frequency `k`, k / (2 nodes) cycles per node.
    double response(int k) const;

    /// The number of nodes for a line of `pixels`: at least 1 per `spacing` pixels and 16 in all,
    /// of small prime factors, but never more than pixels.
    static int node_count(int pixels, double spacing);

  private:
    // The quintic B-spline at -2..2 nodes.
    static constexpr std::array<double, 5> k_at_nodes{1. / 120, 26. / 120, 66. / 120, 26. / 120,
                                                      1. / 120};

    /// Where a pixel lies among the nodes, and its share in each of them.
    static constexpr std::size_t k_taps = 6;
    struct Taps {
        std::array<int, k_taps> nodes{};
        std::array<double, k_taps> weights{};
    };

    int reflected(int node) const;

    int nodes_;
    std::vector<Taps> taps_;
};

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
