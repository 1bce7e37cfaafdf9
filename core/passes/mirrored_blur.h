#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "core/base/grid2d.h"
#include "core/passes/spline_grid.h"
#include "core/scene/water_desc.h"

namespace uw {

/// Width s of a blur along the image's two axes, in pixels: f_px * B * R / (2 pi).
struct BlurWidth {
    double x = 0, y = 0;
};

/// The point spread function of scattering through small angles (physics section 6), as the
/// fraction of a pixel's light that arrives in each other pixel: the kernel, centred on the pixel,
/// integrated over the other one.
///
///   exponential   F^-1{e^{-2 pi s f}} = s / (2 pi (s^2 + r^2)^{3/2})      (Jaffe, McGlamery)
///   gaussian      sigma = sqrt(2) s, whose spectrum falls to 1/e at the same f   (the paper)
///
/// The fractions are positive and sum to 1 for every width; a width of 0 leaves light in its pixel.
/// The kernel is represented by its spectrum (with a period of 1 cycle per pixel), so that its
/// tails are not truncated.
class BlurKernel {
  public:
    /// The kernel for images of `width` times `height` pixels, extended by reflection at their
    /// borders.
    BlurKernel(ForwardScatterDesc::Shape shape, BlurWidth blur, int width, int height)
        : BlurKernel(shape, blur, width, height, width, height) {}
    /// The same, with only the first `columns` and `rows` of the spectrum.
    BlurKernel(ForwardScatterDesc::Shape shape, BlurWidth blur, int width, int height, int columns,
               int rows);

    /// The number of leading columns whose spectrum is not below 1e-15 everywhere.
    int column_count() const { return column_count_; }

    /// Fills the spectrum of column `column` (column / (2 width) cycles per pixel across, row / (2
    /// height) down) from row 0 on, and returns how many rows were filled; the others are below
    /// 1e-15. `spectrum` has room for all rows of the kernel. Thread safe.
    int fill_column(int column, std::span<double> spectrum) const;

  private:
    struct TablePosition {
        std::size_t first;              // of four nodes
        std::array<double, 4> weights;  // of cubic interpolation
    };

    static TablePosition table_position(double f);
    void tabulate_aliases();
    int fill_exponential(double across, std::span<double> spectrum) const;

    ForwardScatterDesc::Shape shape_;
    BlurWidth blur_;
    int width_;
    int height_;
    int column_count_, row_count_;
    std::vector<double> across_, down_;  // per column, per row: factors of the spectrum
    std::vector<double> aliases_;  // table for the sampled spectrum of the exponential, or empty
    std::vector<TablePosition> table_rows_;
};

/// The cosine transform of one line of an image (DCT-II): the Fourier transform of the line
/// extended periodically by reflection, ... c b a | a b c ... z | z y x ... Frequency k of n is
/// k/(2n) cycles per pixel. Uses FFTW, with deterministic plans, so that the same line gives the
/// same bits. Thread safe.
class CosineTransform {
  public:
    /// Plans the transform of lines of `length` >= 1 values.
    explicit CosineTransform(int length);

    int length() const { return length_; }

    /// y_k = 2 sum_j x_j cos(pi k (j + 1/2) / n), in place.
    void forward(double* line) const;
    /// Undoes `forward` up to the factor `scale()`, in place.
    void inverse(double* line) const;
    /// The factor by which `forward` and then `inverse` scale a line: 2n.
    double scale() const { return 2.0 * length_; }

  private:
    struct Plans;
    int length_;
    std::shared_ptr<const Plans> plans_;
};

/// Sums images, each blurred with its own kernel. Images are extended beyond their borders by
/// repeated reflection, without padding, so that the borders do not darken, and exactly as much
/// light enters across them as leaves. Only the sum is stored, however many images there are. The
/// result does not depend on the number of threads.
///
/// Wide kernels do not need every pixel: the images are then spread to the nodes of a spline and
/// transformed there, and the sum is interpolated from the nodes.
class MirroredBlur {
  public:
    /// For images of `width` times `height` pixels, blurred at nodes about `spacing` >= 1 pixels
    /// apart. Throws as require_memory.
    MirroredBlur(int width, int height, double spacing = 1);

    const SplineGrid& grid() const { return grid_; }

    /// Adds an image blurred with `kernel`, which must be made for images of this size.
    void add(const RowSource& image, const BlurKernel& kernel);
    /// The same for an image given at the nodes: by its values there or, if they are `means`, by
    /// SplineGrid::means.
    void add_nodes(const RowSource& nodes, bool means, const BlurKernel& kernel);

    /// Whether an image was added since the sum was last finished.
    bool any() const { return any_; }

    /// Passes the sum to `sink` and resets to zero.
    void finish(const RowSink& sink);
    /// Passes the spline coefficients of the sum, one row of nodes at a time, and resets to zero.
    void finish_nodes(const RowSink& sink);

  private:
    enum class Input { pixels, node_values, node_means };

    void add_columns(const BlurKernel& kernel, Input input);
    // Transforms the columns of the sum back and stores them in `image_`, with a row for each pixel
    // or each node.
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
