#include "core/frame/tile_renderer.h"

namespace uw {

TileRenderer::TileRenderer(const PixelRenderer& renderer, double in_scatter_tolerance,
                           const MultipleLight* multiple)
    : renderer_(renderer), multiple_(multiple) {
    if (in_scatter_tolerance > 0)
        lattice_.emplace(renderer.rays(), renderer.in_scatter(), in_scatter_tolerance);
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
    if (multiple_) multiple_->add(view, light_, first_sample, result_);
    return {view, light_, first_sample, result_};
}

}  // namespace uw
