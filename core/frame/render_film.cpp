#include "core/frame/render_film.h"

#include <algorithm>
#include <atomic>
#include <memory>
#include <mutex>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/frame/tile_renderer.h"

namespace uw {

namespace {

constexpr int k_tile = InScatterLattice::k_tile;  // pixels along an edge

// The part of the tile that begins at (x0, y0) within `bounds`.
PixelWindow tile_within(int x0, int y0, const PixelWindow& bounds) {
    return {std::max(x0, bounds.x0), std::max(y0, bounds.y0), std::min(x0 + k_tile, bounds.x1),
            std::min(y0 + k_tile, bounds.y1)};
}

/// Writes values one after another from a layer's first channel on, if the layer is wanted.
class LayerWriter {
  public:
    LayerWriter(const LayerPlan& plan, int band_count, std::span<float> channels)
        : plan_(plan), bands_(static_cast<std::size_t>(band_count)), channels_(channels) {}

    void bands(int first_channel, const Spectrum& values, double factor = 1) {
        if (first_channel < 0) return;
        for (std::size_t b = 0; b < bands_; ++b)
            channels_[static_cast<std::size_t>(first_channel) + b] =
                static_cast<float>(factor * values[b]);
    }
    void bands(Layer layer, const Spectrum& values, double factor = 1) {
        bands(plan_.first_channel(layer), values, factor);
    }
    void scalar(Layer layer, double value) {
        if (plan_.has(layer))
            channels_[static_cast<std::size_t>(plan_.first_channel(layer))] =
                static_cast<float>(value);
    }
    void vector(Layer layer, double x, double y, double z) {
        if (!plan_.has(layer)) return;
        const auto first = static_cast<std::size_t>(plan_.first_channel(layer));
        channels_[first] = static_cast<float>(x);
        channels_[first + 1] = static_cast<float>(y);
        channels_[first + 2] = static_cast<float>(z);
    }

  private:
    const LayerPlan& plan_;
    std::size_t bands_;
    std::span<float> channels_;
};

}  // namespace

void store_pixel(const PixelResult& result, const LayerPlan& plan, const BandColour& colour,
                 int band_count, std::span<float> channels) {
    const double factor = result.pixel_factor;
    // Components are rounded to float before they are added: their sum is the total to the bit.
    Spectrum total{};
    for (std::size_t b = 0; b < static_cast<std::size_t>(band_count); ++b)
        total[b] = static_cast<double>(static_cast<float>(factor * result.direct[b]) +
                                       static_cast<float>(factor * result.backscatter[b]));
    const LinearRgb rgb = colour(total);
    for (std::size_t i = 0; i < 3; ++i) channels[i] = static_cast<float>(rgb[i]);
    channels[k_alpha] = static_cast<float>(result.alpha);

    LayerWriter out(plan, band_count, channels);
    out.bands(Layer::total, total);
    out.bands(Layer::direct, result.direct, factor);
    out.bands(Layer::backscatter, result.backscatter, factor);
    out.bands(Layer::backscatter_first, result.backscatter_first, factor);
    out.bands(Layer::irradiance, result.irradiance);
    out.bands(Layer::exitance, result.exitance);
    out.scalar(Layer::lit, result.lit);
    out.bands(Layer::clean, result.clean, factor);
    out.bands(Layer::transmittance, result.transmittance);
    for (std::size_t j = 0; j < result.lamps.size(); ++j)
        out.bands(plan.first_channel_of_lamp(j), result.lamps[j], factor);
    if (!result.has_hit) return;
    out.bands(Layer::albedo, result.hit.reflectance);
    out.scalar(Layer::depth, result.depth_z);
    out.scalar(Layer::range, result.range);
    out.scalar(Layer::path, result.path);
    out.vector(Layer::normal, result.hit.normal.x, result.hit.normal.y, result.hit.normal.z);
    out.vector(Layer::position, result.hit.position.x, result.hit.position.y,
               result.hit.position.z);
    out.scalar(Layer::id, result.hit.object_id);
}

namespace {

/// Lends tile renderers, as many as tiles are rendered at once.
class TileRendererPool {
  public:
    TileRendererPool(const PixelRenderer& renderer, double in_scatter_tolerance)
        : renderer_(renderer), water_tolerance_(in_scatter_tolerance) {}

    std::unique_ptr<TileRenderer> take() {
        {
            const std::lock_guard lock(mutex_);
            if (!free_.empty()) {
                std::unique_ptr<TileRenderer> taken = std::move(free_.back());
                free_.pop_back();
                return taken;
            }
        }
        return std::make_unique<TileRenderer>(renderer_, water_tolerance_);
    }
    void give_back(std::unique_ptr<TileRenderer> renderer) {
        const std::lock_guard lock(mutex_);
        free_.push_back(std::move(renderer));
    }

  private:
    const PixelRenderer& renderer_;
    double water_tolerance_;
    std::mutex mutex_;
    std::vector<std::unique_ptr<TileRenderer>> free_;
};

}  // namespace

void render_film(const PixelRenderer& renderer, double in_scatter_tolerance, const LayerPlan& plan,
                 const BandColour& colour, Film& film, const ProgressCallback& progress,
                 const PixelCallback& pixel_done) {
    const PixelWindow& window = film.window();
    const PixelWindow image{0, 0, film.width(), film.height()};
    const int left = window.x0 / k_tile, top = window.y0 / k_tile;
    const int columns = (window.x1 + k_tile - 1) / k_tile - left;
    const int rows = (window.y1 + k_tile - 1) / k_tile - top;
    const auto tiles = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
    // Counted by rows of tiles: a tile of the reference integrator may take a minute.
    const auto all = static_cast<double>(columns) * window.height();
    std::atomic<std::size_t> done = 0;
    TileRendererPool pool(renderer, in_scatter_tolerance);
    parallel_for(tiles, [&](std::size_t tile) {
        const int x0 = (left + static_cast<int>(tile) % columns) * k_tile;
        const int y0 = (top + static_cast<int>(tile) / columns) * k_tile;
        std::unique_ptr<TileRenderer> tile_renderer = pool.take();
        tile_renderer->begin(tile_within(x0, y0, image));
        const PixelWindow wanted = tile_within(x0, y0, window);
        for (int y = wanted.y0; y < wanted.y1; ++y) {
            for (int x = wanted.x0; x < wanted.x1; ++x) {
                const PixelResult& result = tile_renderer->render(x, y);
                store_pixel(result, plan, colour, renderer.band_count(), film.pixel(x, y));
                if (pixel_done) pixel_done(x, y, tile_renderer->view(), result);
            }
            if (!progress(static_cast<double>(++done) / all)) throw Interrupted();
        }
        pool.give_back(std::move(tile_renderer));
    });
}

}  // namespace uw
