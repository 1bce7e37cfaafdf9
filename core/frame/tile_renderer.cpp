#include "core/frame/tile_renderer.h"

namespace uw {

TileRenderer::TileRenderer(const PixelRenderer& renderer, double in_scatter_tolerance)
    : renderer_(renderer) {
    if (in_scatter_tolerance > 0)
        lattice_.emplace(renderer.rays(), renderer.water(), in_scatter_tolerance);
    else
        row_.resize(renderer.water().row_size());
}

void TileRenderer::begin(const PixelWindow& tile) {
    tile_ = tile;
    views_.resize(static_cast<std::size_t>(tile.width()) * static_cast<std::size_t>(tile.height()));
    renderer_.look(tile, views_);
    renderer_.light_surfaces(views_, light_);
    first_samples_.clear();
    std::size_t samples = 0;
    for (const PixelView& view : views_) {
        first_samples_.push_back(samples);
        samples += view.samples.size();
    }
    if (lattice_) lattice_->gather(tile, views_);
}

const PixelResult& TileRenderer::render(int x, int y) {
    const std::size_t pixel = index(x, y);
    view_ = &views_[pixel];
    if (!lattice_) renderer_.water().gather(*view_, row_);
    renderer_.shade(*view_, light_, first_samples_[pixel], lattice_ ? lattice_->row(pixel) : row_,
                    result_);
    return result_;
}

}  // namespace uw
