#include "core/passes/pixel_pass.h"

#include <algorithm>
#include <atomic>
#include <memory>
#include <mutex>

#include "core/base/error.h"
#include "core/base/parallel.h"

namespace uw {

namespace {

/// Makes the ground truth of a pixel that of a particle of snow at this distance along its ray: a
/// disk that faces the camera, with the number after those of all objects for its id.
void hold(double distance, const PixelView& view, const PixelRenderer& renderer,
          PixelResult& result) {
    result.has_hit = true;
    result.hit = {};
    result.hit.distance = distance;
    result.hit.position = view.ray->at(distance);
    result.hit.normal = result.hit.geometric_normal = -view.ray->direction;
    result.hit.object_id =
        static_cast<std::uint32_t>(renderer.scene().surfaces->names().objects.size()) + 1;
    const Point3 in_camera = renderer.rays().world_from_camera().inverse() * result.hit.position;
    result.depth_z = in_camera.z;
    result.range = glm::length(from_origin(in_camera));
    result.path = distance;
}

}  // namespace

TileRenderer::TileRenderer(const PixelRenderer& renderer, double in_scatter_tolerance,
                           const PixelAdditions& additions)
    : renderer_(renderer), additions_(additions) {
    if (in_scatter_tolerance > 0)
        lattice_.emplace(renderer.rays(), renderer.scene(), renderer.in_scatter(),
                         in_scatter_tolerance);
    else
        in_scatter_.resize(renderer.in_scatter().value_count());
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
    if (lattice_) lattice_->evaluate(tile, views_);
}

RenderedPixel TileRenderer::render(int x, int y) {
    const std::size_t pixel = views_.index(x - tile_.x0, y - tile_.y0);
    const PixelView& view = views_[pixel];
    const std::size_t first_sample = first_samples_[pixel];
    if (!lattice_) renderer_.in_scatter().integrate(view, in_scatter_);
    renderer_.shade(view, light_, first_sample, lattice_ ? lattice_->values(pixel) : in_scatter_,
                    result_);
    if (additions_.multiple) additions_.multiple->add(view, light_, first_sample, result_);
    if (additions_.snow && view.ray) add_snow(x, y, view);
    return {view, light_, first_sample, result_};
}

void TileRenderer::add_snow(int x, int y, const PixelView& view) {
    const double end = view.has_hit ? view.path : view.distances.back();
    result_.snow = additions_.snow->radiance(x, y, end, result_.direct + result_.multiple_surface,
                                             result_.backscatter + result_.multiple_volume);
    const double held = additions_.snow->held(x, y);
    if (additions_.snow_in_ground_truth && held > 0) hold(held, view, renderer_, result_);
}

namespace {

constexpr int k_tile = InScatterLattice::k_tile;  // pixels along an edge

// The part of the tile that begins at (x0, y0) within `bounds`.
PixelWindow tile_within(int x0, int y0, const PixelWindow& bounds) {
    return {std::max(x0, bounds.x0), std::max(y0, bounds.y0), std::min(x0 + k_tile, bounds.x1),
            std::min(y0 + k_tile, bounds.y1)};
}

/// Lends out tile renderers, one for each tile in progress.
class TileRendererPool {
  public:
    TileRendererPool(const PixelRenderer& renderer, double in_scatter_tolerance,
                     const PixelAdditions& additions)
        : renderer_(renderer), in_scatter_tolerance_(in_scatter_tolerance), additions_(additions) {}

    std::unique_ptr<TileRenderer> take() {
        {
            const std::lock_guard lock(mutex_);
            if (!free_.empty()) {
                std::unique_ptr<TileRenderer> taken = std::move(free_.back());
                free_.pop_back();
                return taken;
            }
        }
        return std::make_unique<TileRenderer>(renderer_, in_scatter_tolerance_, additions_);
    }
    void give_back(std::unique_ptr<TileRenderer> renderer) {
        const std::lock_guard lock(mutex_);
        free_.push_back(std::move(renderer));
    }

  private:
    const PixelRenderer& renderer_;
    double in_scatter_tolerance_;
    PixelAdditions additions_;
    std::mutex mutex_;
    std::vector<std::unique_ptr<TileRenderer>> free_;
};

}  // namespace

void render_film(const PixelRenderer& renderer, double in_scatter_tolerance, const LayerPlan& plan,
                 const BandColour& colour, Film& film, const ProgressCallback& progress,
                 const PixelCallback& pixel_done, const PixelAdditions& additions) {
    const PixelWindow& window = film.window();
    const PixelWindow image{0, 0, film.width(), film.height()};
    const int left = window.x0 / k_tile, top = window.y0 / k_tile;
    const int columns = (window.x1 + k_tile - 1) / k_tile - left;
    const int rows = (window.y1 + k_tile - 1) / k_tile - top;
    const auto tiles = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
    // Counted in rows of pixels within tiles: a tile may take the reference integrator a minute.
    const auto all = static_cast<double>(columns) * window.height();
    std::atomic<std::size_t> done = 0;
    TileRendererPool pool(renderer, in_scatter_tolerance, additions);
    parallel_for(tiles, [&](std::size_t tile) {
        const int x0 = (left + static_cast<int>(tile) % columns) * k_tile;
        const int y0 = (top + static_cast<int>(tile) / columns) * k_tile;
        std::unique_ptr<TileRenderer> tile_renderer = pool.take();
        tile_renderer->begin(tile_within(x0, y0, image));
        const PixelWindow wanted = tile_within(x0, y0, window);
        for (int y = wanted.y0; y < wanted.y1; ++y) {
            for (int x = wanted.x0; x < wanted.x1; ++x) {
                const RenderedPixel pixel = tile_renderer->render(x, y);
                store_pixel(pixel.result, plan, colour, film.pixel(x, y));
                if (pixel_done) pixel_done(x, y, pixel);
            }
            if (!progress(static_cast<double>(++done) / all)) throw Interrupted();
        }
        pool.give_back(std::move(tile_renderer));
    });
}

}  // namespace uw
