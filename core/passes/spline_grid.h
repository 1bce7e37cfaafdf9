#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "core/base/grid2d.h"

namespace uw {

/// A quintic B-spline on a line of pixels. Pixels and nodes lie at the centres of equal parts of
/// the line and are extended by reflection at its ends. With as many nodes as pixels, spreading and
/// interpolation are the identity.
///
/// `spread` multiplies the cosine transform of the pixels by `response`, and `interpolate` that of
/// the coefficients, except for aliases. The spline suppresses those of frequencies near whole
/// numbers of cycles per node; those near half a cycle are left to a kernel without such
/// frequencies.
class SplineLine {
  public:
    /// Precondition: 1 <= nodes <= pixels.
    SplineLine(int pixels, int nodes);

    int nodes() const { return nodes_; }
    /// Whether pixels and nodes are the same.
    bool is_identity() const { return taps_.empty(); }
    /// Calls `tap(node, weight)` for each node whose B-spline is not zero at pixel `i`.
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

    /// Adds each pixel to the nodes around it, weighted by their B-splines.
    void spread(std::span<const double> pixels, std::span<double> nodes) const;
    /// Evaluates the spline with the coefficients `nodes` at the pixels.
    void interpolate(std::span<const double> nodes, std::span<double> pixels) const;
    /// The Fourier transform of the B-spline at frequency `k`, k / (2 nodes) cycles per node.
    double response(int k) const;

    /// Returns the number of nodes for a line of `pixels`: at least 1 per `spacing` pixels and 16
    /// in all, a product of small primes, but no more than there are pixels.
    static int node_count(int pixels, double spacing);

  private:
    // The quintic B-spline at -2..2 nodes.
    static constexpr std::array<double, 5> k_at_nodes{1. / 120, 26. / 120, 66. / 120, 26. / 120,
                                                      1. / 120};

    /// The nodes around a pixel, and the values of their B-splines at the pixel.
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
    /// The nodes lie about `spacing` >= 1 pixels apart.
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

    /// Computes the means of an image around each node, weighted as by SplineLine::spread. The
    /// result does not depend on the number of threads.
    void means(const RowSource& pixels, Grid2D<float>& nodes) const;
    /// Evaluates the spline with these coefficients at the nodes.
    void values(const Grid2D<float>& coefficients, Grid2D<float>& nodes) const;
    /// Evaluates it at the pixels, and passes the rows to `sink`, from any thread.
    void interpolate(const Grid2D<float>& coefficients, const RowSink& sink) const;
    /// Evaluates two splines at pixel (x, y).
    std::array<float, 2> at(const Grid2D<float>& first, const Grid2D<float>& second, int x,
                            int y) const;

  private:
    int width_, height_;
    SplineLine x_, y_;
};

}  // namespace uw
