#include "core/passes/error_sums.h"

#include <algorithm>
#include <cmath>

namespace uw {

namespace {

// Parts are squares of the image's height over this.
constexpr int k_parts_of_height = 10;
// Parts that are darker, relative to the image's mean, count as if they were as bright.
constexpr double k_min_light_of_part = 0.01;

double relative_error(double light, double squares, double count) {
    return light > 0 ? std::sqrt(squares * count) / light : 0;
}

}  // namespace

void ErrorSums::Sums::add(const Sums& other) {
    pixels += other.pixels;
    for (std::size_t b = 0; b < light.size(); ++b) {
        light[b] += other.light[b];
        squares[b] += other.squares[b];
    }
}

double ErrorSums::Sums::error(std::size_t band, double min_mean) const {
    return relative_error(std::max(light[band], pixels * min_mean), squares[band], pixels);
}

ErrorSums::ErrorSums(const PixelWindow& window, int height, std::size_t bands)
    : window_(window), bands_(bands), side_(std::max(1, height / k_parts_of_height)) {
    const int column = window.x0 / k_tile, row = window.y0 / k_tile;
    tiles_.assign(1 + (window.x1 - 1) / k_tile - column, 1 + (window.y1 - 1) / k_tile - row);
    for (int j = 0; j < tiles_.height(); ++j)
        for (int i = 0; i < tiles_.width(); ++i) {
            Tile& tile = tiles_(i, j);
            const int x = (column + i) * k_tile, y = (row + j) * k_tile;
            tile.first_column = x / side_;
            tile.first_row = y / side_;
            tile.parts.assign((x + k_tile - 1) / side_ - tile.first_column + 1,
                              (y + k_tile - 1) / side_ - tile.first_row + 1, Sums(bands));
        }
}

ErrorSums::Tile& ErrorSums::tile_of(const RenderedPixel& pixel) {
    return tiles_(pixel.x / k_tile - window_.x0 / k_tile, pixel.y / k_tile - window_.y0 / k_tile);
}

void ErrorSums::add(const RenderedPixel& pixel) {
    Tile& tile = tile_of(pixel);
    Sums& sums = tile.parts(pixel.x / side_ - tile.first_column, pixel.y / side_ - tile.first_row);
    const PixelResult& result = pixel.result;
    ++sums.pixels;
    for (std::size_t b = 0; b < bands_; ++b) {
        sums.light[b] +=
            result.pixel_factor * (result.direct[b] + result.backscatter[b] +
                                   result.multiple_volume[b] + result.multiple_surface[b]);
        sums.squares[b] += result.error[b] * result.error[b];
    }
}

void ErrorSums::report(ImageProgress& reached) const {
    const int first_column = window_.x0 / side_, first_row = window_.y0 / side_;
    Grid2D<Sums> parts(1 + (window_.x1 - 1) / side_ - first_column,
                       1 + (window_.y1 - 1) / side_ - first_row, Sums(bands_));
    Sums image(bands_);
    for (const Tile& tile : tiles_)
        for (int j = 0; j < tile.parts.height(); ++j)
            for (int i = 0; i < tile.parts.width(); ++i) {
                const Sums& sums = tile.parts(i, j);
                if (sums.pixels == 0) continue;
                image.add(sums);
                parts(tile.first_column + i - first_column, tile.first_row + j - first_row)
                    .add(sums);
            }
    double light = 0, squares = 0;
    reached.multiple_error_of_bands.clear();
    for (std::size_t b = 0; b < bands_; ++b) {
        reached.multiple_error_of_bands.push_back(image.error(b, 0));
        light += image.light[b];
        squares += image.squares[b];
    }
    reached.multiple_error =
        relative_error(light, squares, image.pixels * static_cast<double>(bands_));
    report_parts(parts, image, reached);
}

void ErrorSums::report_parts(const Grid2D<Sums>& parts, const Sums& image,
                             ImageProgress& reached) const {
    double all_squares = 0, count = 0, worst = 0;
    for (const Sums& part : parts) {
        if (part.pixels == 0) continue;
        double squares = 0;
        for (std::size_t b = 0; b < bands_; ++b) {
            const double error = part.error(b, k_min_light_of_part * image.light[b] / image.pixels);
            squares += error * error / static_cast<double>(bands_);
        }
        all_squares += squares;
        worst = std::max(worst, squares);
        ++count;
    }
    reached.multiple_error_of_parts = count > 0 ? std::sqrt(all_squares / count) : 0;
    reached.multiple_error_of_worst_part = std::sqrt(worst);
}

}  // namespace uw
