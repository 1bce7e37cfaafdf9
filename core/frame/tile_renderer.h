#pragma once

#include <optional>
#include <vector>

#include "core/base/grid2d.h"
#include "core/frame/in_scatter_lattice.h"
#include "core/frame/pixel_renderer.h"

namespace uw {

/// Renders one tile after another: what its pixels' rays meet, the water on the way, and both
/// together.
class TileRenderer {
  public:
    /// `in_scatter_tolerance`: of InScatterLattice; 0 integrates every pixel's own ray.
    TileRenderer(const PixelRenderer& renderer, double in_scatter_tolerance);

    /// Traces the whole of a tile, whatever part of it is rendered: its lattice depends on all of
    /// it, and its surfaces are lit together.
    void begin(const PixelWindow& tile);

    /// Renders a pixel of the tile.
    const PixelResult& render(int x, int y);
    /// Of the pixel rendered last.
    const PixelView& view() const { return *view_; }

  private:
    const PixelRenderer& renderer_;
    std::optional<InScatterLattice> lattice_;  // none: every pixel by itself
    PixelWindow tile_;
    Grid2D<PixelView> views_;                 // of the tile
    SurfaceLight light_;                      // on all their samples
    std::vector<std::size_t> first_samples_;  // of each view among these
    const PixelView* view_ = nullptr;
    std::vector<double> in_scatter_;  // of the pixel, without a lattice
    PixelResult result_;
};

}  // namespace uw
