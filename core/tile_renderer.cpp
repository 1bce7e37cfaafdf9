#include "core/tile_renderer.h"

namespace uw {

TileRenderer::TileRenderer(const PixelRenderer& renderer, double water_tolerance)
    : renderer_(renderer), views_(1) {
    if (water_tolerance > 0)
        lattice_.emplace(renderer.rays(), renderer.water(), water_tolerance);
    else
        row_.resize(renderer.water().row_size());
}

void TileRenderer::begin(const PixelWindow& tile) {
    tile_ = tile;
    if (!lattice_) return;
    views_.resize(static_cast<std::size_t>(tile.width()) * static_cast<std::size_t>(tile.height()));
    renderer_.look(tile, views_);
    lattice_->gather(tile, views_);
}

const PixelResult& TileRenderer::render(int x, int y) {
    if (lattice_) {
        view_ = &views_[index(x, y)];
        renderer_.light(*view_, lattice_->row(index(x, y)), result_);
    } else {
        view_ = &views_.front();
        renderer_.look(x, y, views_.front());
        renderer_.water().gather(*view_, row_);
        renderer_.light(*view_, row_, result_);
    }
    return result_;
}

}  // namespace uw
