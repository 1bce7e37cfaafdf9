#pragma once

#include <cstddef>
#include <vector>

#include "core/base/grid2d.h"
#include "core/image/film.h"
#include "core/passes/in_scatter_lattice.h"
#include "core/passes/pass.h"

namespace uw {

/// Sums all light and the squares of its errors over the parts of an image, by band, for the
/// standard errors that ImageProgress states. Each tile, which one thread renders, has its own
/// sums, so that the result is the same to the bit for any number of threads. Thread safe for
/// pixels of different tiles.
class ErrorSums {
  public:
    /// `height`: of the whole image, of which `window` is rendered.
    ErrorSums(const PixelWindow& window, int height, std::size_t bands);

    void add(const RenderedPixel& pixel);
    void report(ImageProgress& reached) const;

  private:
    static constexpr int k_tile = InScatterLattice::k_tile;  // of render_tiles

    struct Sums {
        double pixels = 0;
        std::vector<double> light, squares;  // by band

        explicit Sums(std::size_t bands = 0) : light(bands), squares(bands) {}
        void add(const Sums& other);
        // Relative to the light of the band, or to this mean if it is more.
        double error(std::size_t band, double min_mean) const;
    };
    struct Tile {
        int first_column = 0, first_row = 0;  // of the parts that it meets
        Grid2D<Sums> parts;
    };

    Tile& tile_of(const RenderedPixel& pixel);
    void report_parts(const Grid2D<Sums>& parts, const Sums& image, ImageProgress& reached) const;

    PixelWindow window_;
    std::size_t bands_;
    int side_;  // of a part [pixels]
    Grid2D<Tile> tiles_;
};

}  // namespace uw
