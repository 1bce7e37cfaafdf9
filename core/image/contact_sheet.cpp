#include "core/image/contact_sheet.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/error.h"
#include "core/image/colour.h"
#include "core/image/image_file.h"

namespace uw {
namespace {

constexpr int k_widest_picture = 320, k_widest_sheet = 3840, k_gap = 4;
constexpr Srgb8 k_ground{32, 32, 32};

double linear(float encoded) {
    const double value = static_cast<double>(encoded);
    return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

/// Which source pixels a pixel of the smaller image covers, along one side.
struct Cover {
    double begin, end;

    Cover(int index, int small, int large)
        : begin(static_cast<double>(index) * large / small),
          end(static_cast<double>(index + 1) * large / small) {}
    /// How much of source pixel i.
    double of(int i) const { return std::min(end, i + 1.0) - std::max(begin, 1.0 * i); }
    int first() const { return static_cast<int>(begin); }
    int last() const { return static_cast<int>(std::ceil(end)); }  // excluded
};

Preview scaled_down(const PixelImage& image, int widest) {
    const int width = std::min(image.width, widest);
    const int height = std::max(
        1, static_cast<int>(std::lround(static_cast<double>(image.height) * width / image.width)));
    std::vector<double> light(image.pixels.size());
    const auto row_values =
        static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.channels);
    for (std::size_t first = 0; first < light.size(); first += row_values) {
        throw_if_stopped();
        std::transform(&image.pixels[first], &image.pixels[first] + row_values, &light[first],
                       linear);
    }
    const SrgbBytes& encode = srgb_bytes();
    Preview small(width, height);
    for (int y = 0; y < height; ++y) {
        throw_if_stopped();
        for (int x = 0; x < width; ++x) {
            const Cover across(x, width, image.width), down(y, height, image.height);
            LinearRgb sum{};
            double area = 0;
            for (int j = down.first(); j < std::min(down.last(), image.height); ++j)
                for (int i = across.first(); i < std::min(across.last(), image.width); ++i) {
                    const double weight = across.of(i) * down.of(j);
                    const auto at =
                        static_cast<std::size_t>(j) * static_cast<std::size_t>(image.width) +
                        static_cast<std::size_t>(i);
                    for (std::size_t c = 0; c < 3; ++c)
                        sum[c] += weight * light[at * static_cast<std::size_t>(image.channels) +
                                                 (image.channels < 3 ? 0 : c)];
                    area += weight;
                }
            for (std::size_t c = 0; c < 3; ++c)
                small.row(y)[static_cast<std::size_t>(x)][c] = encode(sum[c] / area);
        }
    }
    return small;
}

/// Columns that make a sheet of `count` pictures about 16:9.
int usual_columns(std::size_t count, double height_to_width) {
    const double columns = std::sqrt(static_cast<double>(count) * height_to_width * 16 / 9);
    return std::clamp(static_cast<int>(std::lround(columns)), 1, static_cast<int>(count));
}

}  // namespace

Preview contact_sheet(std::span<const std::filesystem::path> pictures, int columns) {
    std::vector<Preview> small(pictures.size());
    int cell_width = 1, cell_height = 1;
    for (std::size_t i = 0; i < pictures.size(); ++i) {
        if (!std::filesystem::is_regular_file(pictures[i])) continue;
        const PixelImage image = read_own_image(pictures[i]);
        if (columns == 0)
            columns =
                usual_columns(pictures.size(), static_cast<double>(image.height) / image.width);
        small[i] =
            scaled_down(image, std::clamp(k_widest_sheet / columns - k_gap, 1, k_widest_picture));
        cell_width = std::max(cell_width, small[i].width());
        cell_height = std::max(cell_height, small[i].height());
    }
    columns = std::max(columns, 1);
    const int rows = (static_cast<int>(pictures.size()) + columns - 1) / columns;
    Preview sheet(columns * (cell_width + k_gap) + k_gap, rows * (cell_height + k_gap) + k_gap,
                  k_ground);
    for (std::size_t i = 0; i < small.size(); ++i) {
        const int left = k_gap + static_cast<int>(i) % columns * (cell_width + k_gap);
        const int top = k_gap + static_cast<int>(i) / columns * (cell_height + k_gap);
        for (int y = 0; y < small[i].height(); ++y)
            std::ranges::copy(small[i].row(y), sheet.row(top + y).begin() + left);
    }
    return sheet;
}

}  // namespace uw
