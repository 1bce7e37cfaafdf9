#include "core/snow/snow_image.h"

#include <algorithm>
#include <tuple>

#include "core/base/parallel.h"

namespace uw {
namespace {

constexpr int k_tile = 32;  // pixels along an edge
// Beside the bands of a pixel: the shares hidden of surfaces and of the water, the distance held.
enum : std::size_t { k_covered, k_hidden, k_held, k_others };
// A particle that covers this much of a pixel is what ground truth holds.
constexpr double k_mostly = 0.5;

/// The splats of each tile of a window, row by row.
class TileLists {
  public:
    explicit TileLists(const PixelWindow& window)
        : window_(window),
          columns_((window.width() + k_tile - 1) / k_tile),
          lists_(static_cast<std::size_t>(columns_ * ((window.height() + k_tile - 1) / k_tile))) {}

    void add(std::uint32_t index, const PixelWindow& bounds) {
        const PixelWindow inside = intersection(bounds, window_);
        if (inside.width() <= 0 || inside.height() <= 0) return;
        for (int j = (inside.y0 - window_.y0) / k_tile; j <= (inside.y1 - 1 - window_.y0) / k_tile;
             ++j)
            for (int i = (inside.x0 - window_.x0) / k_tile;
                 i <= (inside.x1 - 1 - window_.x0) / k_tile; ++i)
                lists_[static_cast<std::size_t>(j * columns_ + i)].push_back(index);
    }
    std::size_t count() const { return lists_.size(); }
    std::vector<std::uint32_t>& list(std::size_t tile) { return lists_[tile]; }
    PixelWindow window(std::size_t tile) const {
        const int x0 = window_.x0 + static_cast<int>(tile) % columns_ * k_tile;
        const int y0 = window_.y0 + static_cast<int>(tile) / columns_ * k_tile;
        return intersection({x0, y0, x0 + k_tile, y0 + k_tile}, window_);
    }

  private:
    PixelWindow window_;
    int columns_;
    std::vector<std::vector<std::uint32_t>> lists_;
};

}  // namespace

void SnowSplats::append(const SnowSplats& more) {
    const auto first = static_cast<std::uint32_t>(radiance.size());
    radiance.insert(radiance.end(), more.radiance.begin(), more.radiance.end());
    for (SnowSplat splat : more.splats) {
        splat.radiance += first;
        splats.push_back(splat);
    }
}

SnowImage::SnowImage(const PixelWindow& window, std::size_t bands, const SnowSplats& all)
    : window_(window),
      bands_(bands),
      values_(window.width() * static_cast<int>(bands + k_others), window.height()) {
    TileLists tiles(window);
    for (std::size_t i = 0; i < all.splats.size(); ++i)
        tiles.add(static_cast<std::uint32_t>(i), all.splats[i].footprint.bounds());
    parallel_for(tiles.count(), [&](std::size_t tile) {
        std::vector<std::uint32_t>& list = tiles.list(tile);
        std::ranges::sort(list, {}, [&](std::uint32_t i) {
            return std::tuple(all.splats[i].distance, all.splats[i].id);
        });
        for (const std::uint32_t i : list) {
            const SnowSplat& splat = all.splats[i];
            draw(splat, std::span(all.radiance).subspan(splat.radiance, bands_),
                 tiles.window(tile));
        }
    });
}

std::span<float> SnowImage::values(int x, int y) {
    const std::size_t count = bands_ + k_others;
    return values_.row(y - window_.y0)
        .subspan(static_cast<std::size_t>(x - window_.x0) * count, count);
}

void SnowImage::draw(const SnowSplat& splat, std::span<const float> radiance,
                     const PixelWindow& tile) {
    thread_local Grid2D<double> shares;
    const PixelWindow inside = intersection(splat.footprint.bounds(), tile);
    shares.assign(inside.width(), inside.height());
    splat.footprint.add_shares(inside, shares);
    for (int y = inside.y0; y < inside.y1; ++y)
        for (int x = inside.x0; x < inside.x1; ++x) {
            const double cover =
                std::min(1.0, splat.footprint.area() * shares(x - inside.x0, y - inside.y0));
            if (cover == 0) continue;
            const std::span<float> pixel = values(x, y);
            const std::span<float> others = pixel.subspan(bands_);
            // The share of this particle that those before it leave.
            const double seen = cover * (1 - static_cast<double>(others[k_covered]));
            for (std::size_t b = 0; b < bands_; ++b)
                pixel[b] += static_cast<float>(seen * static_cast<double>(radiance[b]));
            others[k_covered] += static_cast<float>(seen);
            others[k_hidden] += static_cast<float>(seen * static_cast<double>(splat.hidden));
            if (cover >= k_mostly && others[k_held] == 0)
                others[k_held] = static_cast<float>(splat.distance);
        }
}

SnowPixel SnowImage::pixel(int x, int y) const {
    const std::size_t count = bands_ + k_others;
    const std::span<const float> values =
        values_.row(y - window_.y0)
            .subspan(static_cast<std::size_t>(x - window_.x0) * count, count);
    const auto other = [&](std::size_t i) { return static_cast<double>(values[bands_ + i]); };
    return {values.first(bands_), 1 - other(k_covered), 1 - other(k_hidden), other(k_held)};
}

}  // namespace uw
