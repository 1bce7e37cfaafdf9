#include "core/passes/pixel_pass.h"

#include <algorithm>
#include <atomic>
#include <memory>
#include <mutex>
#include <vector>

#include "core/base/error.h"
#include "core/base/grid2d.h"
#include "core/base/parallel.h"
#include "core/light/integrator_table.h"
#include "core/passes/in_scatter_lattice.h"

namespace uw {

namespace {

// The maximum relative error of interpolated in-scattered light (InScatterLattice) at the nodes
// that confirm the lattice. Pixels are interpolated from closer nodes and have a quarter of that
// error.
constexpr double k_in_scatter_tolerance = 4e-3;
constexpr double k_draft_tolerance = 0.05;

/// Renders the pixels of one tile at a time.
class TileRenderer {
  public:
    /// As render_tiles.
    TileRenderer(const PixelRenderer& renderer, double in_scatter_tolerance,
                 std::span<const PixelStep> steps);

    /// Traces the whole tile, even if only a part of it is rendered: its lattice depends on all
    /// pixels, and its surfaces are lit in one batch.
    void begin(const PixelWindow& tile);

    /// Renders a pixel of the tile; the result is valid until the next call.
    const PixelResult& render(int x, int y);

  private:
    /// Returns the light scattered into the ray of a pixel of the tile; valid until the next call.
    std::span<const double> in_scatter(std::size_t pixel);

    const PixelRenderer& renderer_;
    std::span<const PixelStep> steps_;
    std::vector<InScatterLattice> lattices_;  // one per part; none: integrate every pixel's ray
    PixelWindow tile_;
    Grid2D<PixelView> views_;                  // of the tile
    SurfaceLight light_;                       // on all their samples
    std::vector<std::size_t> first_samples_;   // index of each view's first sample in light_
    std::vector<double> in_scatter_;           // of the current pixel
    std::vector<double> other_light_, least_;  // by band: of all previous parts, and of one
    PixelResult result_;
};

TileRenderer::TileRenderer(const PixelRenderer& renderer, double in_scatter_tolerance,
                           std::span<const PixelStep> steps)
    : renderer_(renderer), steps_(steps) {
    in_scatter_.resize(renderer.in_scatter().value_count());
    if (in_scatter_tolerance > 0)
        for (const RayInScatter& part : renderer.in_scatter_parts())
            lattices_.emplace_back(renderer.rays(), renderer.scene(), part, in_scatter_tolerance);
}

void TileRenderer::begin(const PixelWindow& tile) {
    tile_ = tile;
    renderer_.trace(tile, views_);
    renderer_.light_surfaces(views_.values(), light_);
    first_samples_.clear();
    std::size_t samples = 0;
    for (const PixelView& view : views_) {
        first_samples_.push_back(samples);
        samples += view.samples.size();
    }
    other_light_.assign(renderer_.in_scatter().band_count(), 0.0);
    for (InScatterLattice& lattice : lattices_) {
        lattice.evaluate(tile, views_, other_light_);
        if (&lattice == &lattices_.back()) break;
        least_.resize(other_light_.size());
        lattice.find_least(least_);
        add(other_light_, least_);
    }
}

std::span<const double> TileRenderer::in_scatter(std::size_t pixel) {
    if (lattices_.size() == 1) return lattices_.front().values(pixel);
    if (lattices_.empty()) renderer_.in_scatter().integrate(views_[pixel], in_scatter_);
    for (std::size_t i = 0; i < lattices_.size(); ++i) {
        const std::span<const double> part = lattices_[i].values(pixel);
        if (i == 0)
            std::ranges::copy(part, in_scatter_.begin());
        else
            add(in_scatter_, part);
    }
    return in_scatter_;
}

const PixelResult& TileRenderer::render(int x, int y) {
    const std::size_t pixel = views_.index(x - tile_.x0, y - tile_.y0);
    const PixelView& view = views_[pixel];
    const std::size_t first_sample = first_samples_[pixel];
    renderer_.shade(view, light_, first_sample, in_scatter(pixel), result_);
    for (const PixelStep& step : steps_) step({x, y, view, light_, first_sample, result_});
    renderer_.weigh(x, y, result_);
    return result_;
}

constexpr int k_tile = InScatterLattice::k_tile;  // pixels along an edge

// Returns the part within `bounds` of the tile that begins at (x0, y0).
PixelWindow tile_within(int x0, int y0, const PixelWindow& bounds) {
    return {std::max(x0, bounds.x0), std::max(y0, bounds.y0), std::min(x0 + k_tile, bounds.x1),
            std::min(y0 + k_tile, bounds.y1)};
}

/// Lends out tile renderers, one for each tile in progress.
class TileRendererPool {
  public:
    TileRendererPool(const PixelRenderer& renderer, double in_scatter_tolerance,
                     std::span<const PixelStep> steps)
        : renderer_(renderer), in_scatter_tolerance_(in_scatter_tolerance), steps_(steps) {}

    std::unique_ptr<TileRenderer> take() {
        {
            const std::lock_guard lock(mutex_);
            if (!free_.empty()) {
                std::unique_ptr<TileRenderer> taken = std::move(free_.back());
                free_.pop_back();
                return taken;
            }
        }
        return std::make_unique<TileRenderer>(renderer_, in_scatter_tolerance_, steps_);
    }
    void give_back(std::unique_ptr<TileRenderer> renderer) {
        const std::lock_guard lock(mutex_);
        free_.push_back(std::move(renderer));
    }

  private:
    const PixelRenderer& renderer_;
    double in_scatter_tolerance_;
    std::span<const PixelStep> steps_;
    std::mutex mutex_;
    std::vector<std::unique_ptr<TileRenderer>> free_;
};

}  // namespace

double in_scatter_tolerance(const RenderDesc& render) {
    const bool exact = render.quality == RenderDesc::Quality::exact;
    if (exact || !integrator_kind(render.integrator).interpolates_between_pixels) return 0;
    return render.quality == RenderDesc::Quality::draft ? k_draft_tolerance
                                                        : k_in_scatter_tolerance;
}

void render_tiles(const PixelRenderer& renderer, double in_scatter_tolerance,
                  std::span<const PixelStep> steps, const PixelWindow& window,
                  const ProgressCallback& progress, const PixelCallback& done) {
    const PixelWindow image{0, 0, renderer.rays().width(), renderer.rays().height()};
    const int left = window.x0 / k_tile, top = window.y0 / k_tile;
    const int columns = (window.x1 + k_tile - 1) / k_tile - left;
    const int rows = (window.y1 + k_tile - 1) / k_tile - top;
    const auto tiles = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
    // Progress counts rows of pixels within tiles, as the reference integrator may take a minute
    // for a tile.
    const auto all = static_cast<double>(columns) * window.height();
    std::atomic<std::size_t> rows_done = 0;
    TileRendererPool pool(renderer, in_scatter_tolerance, steps);
    parallel_for(tiles, [&](std::size_t tile) {
        const int x0 = (left + static_cast<int>(tile) % columns) * k_tile;
        const int y0 = (top + static_cast<int>(tile) / columns) * k_tile;
        std::unique_ptr<TileRenderer> tile_renderer = pool.take();
        tile_renderer->begin(tile_within(x0, y0, image));
        const PixelWindow wanted = tile_within(x0, y0, window);
        for (int y = wanted.y0; y < wanted.y1; ++y) {
            for (int x = wanted.x0; x < wanted.x1; ++x) done(x, y, tile_renderer->render(x, y));
            progress(static_cast<double>(++rows_done) / all);
            throw_if_stopped();
        }
        pool.give_back(std::move(tile_renderer));
    });
}

PixelPass::PixelPass(const RenderDesc& render)
    : Pass(Stage::render),
      in_scatter_tolerance_(uw::in_scatter_tolerance(render)),
      needs_light_(integrator_kind(render.integrator).needs_deep_shadows),
      needs_slabs_(integrator_kind(render.integrator).sums_slabs || render.planes.near ||
                   render.planes.far) {}

PassNeeds PixelPass::needs(const LayerPlan& plan) const {
    return {.light = needs_light_, .slabs = needs_slabs_ || in_scatter_parts(plan).first_slab};
}

void PixelPass::run(Rendering& rendering) {
    Film& film = rendering.film;
    render_tiles(rendering.pixels, in_scatter_tolerance_, rendering.steps, film.window(),
                 rendering.progress_of(*stage()), [&](int x, int y, const PixelResult& pixel) {
                     store_pixel(pixel, rendering.plan, rendering.colour, film.pixel(x, y));
                     if (pixel.shows_lamp) film.mark_lamp(x, y);
                 });
}

}  // namespace uw
