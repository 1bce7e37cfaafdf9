#pragma once

#include <optional>
#include <vector>

#include "core/frame/in_scatter_lattice.h"
#include "core/frame/pixel_renderer.h"

namespace uw {

/// Renders one tile after another: what its pixels look at, the water between, and both together.
class TileRenderer {
  public:
    /// `in_scatter_tolerance`: of InScatterLattice; 0 gathers the water of every pixel by itself.
    TileRenderer(const PixelRenderer& renderer, double in_scatter_tolerance);

    /// Looks at the whole of a tile, whatever part of it is rendered: its lattice depends on it,
    /// and its surfaces are lit together.
    void begin(const PixelWindow& tile);

    /// Renders a pixel of the tile.
    const PixelResult& render(int x, int y);
    /// Of the pixel rendered last.
    const PixelView& view() const { return *view_; }

  private:
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>((y - tile_.y0) * tile_.width() + x - tile_.x0);
    }

    const PixelRenderer& renderer_;
    std::optional<InScatterLattice> lattice_;  // none: every pixel by itself
    PixelWindow tile_;
    std::vector<PixelView> views_;            // of the tile
    SurfaceLight light_;                      // on all their samples
    std::vector<std::size_t> first_samples_;  // of each view among these
    const PixelView* view_ = nullptr;
    std::vector<double> row_;
    PixelResult result_;
};

}  // namespace uw
