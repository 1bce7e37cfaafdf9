#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/scene/forward_scatter_desc.h"

namespace uw {

/// Width s of a blur along the image's two axes, in pixels: f_px * B * R / (2 pi).
struct BlurWidth {
    double x = 0, y = 0;
};

/// The blur of light scattered through small angles (physics section 6), as the fraction of a
/// pixel's light that lands in each other pixel: the kernel, centred on the pixel, integrated over
/// the other.
///
///   exponential   F^-1{e^{-2 pi s f}} = s / (2 pi (s^2 + r^2)^{3/2})      (Jaffe, McGlamery)
///   gaussian      sigma = sqrt(2) s, whose spectrum falls to 1/e at the same f   (the paper)
///
/// The fractions are positive and sum to 1 for every width; a width of 0 leaves the light where it
/// is. The kernel is represented by its spectrum (with a period of 1 cycle per pixel), so that its
/// tails are not truncated.
class BlurKernel {
  public:
    /// The kernel for images of `width` times `height` pixels, extended by reflection at their
    /// borders.
    BlurKernel(ForwardScatterDesc::Shape shape, BlurWidth blur, int width, int height)
        : BlurKernel(shape, blur, width, height, width, height) {}
    /// The same for the first `columns` and `rows` of the spectrum alone.
    BlurKernel(ForwardScatterDesc::Shape shape, BlurWidth blur, int width, int height, int columns,
               int rows);

    /// Number of leading columns whose spectrum is not everywhere below 1e-15.
    int column_count() const { return column_count_; }

    /// Fills the spectrum of column `column` (column / (2 width) cycles per pixel across, row /
    /// (2 height) down) from row 0, and returns how many rows were filled; the rest are below
    /// 1e-15. `spectrum` holds all rows that are asked for. Thread safe.
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
    std::vector<double> aliases_;        // of the exponential's sampled spectrum, or empty
    std::vector<TablePosition> table_rows_;
};

}  // namespace uw
