#pragma once

#include <optional>
#include <vector>

#include "core/base/grid2d.h"
#include "core/frame/in_scatter_lattice.h"
#include "core/frame/multiple_light.h"
#include "core/frame/pixel_renderer.h"
#include "core/snow/snow_layer.h"

namespace uw {

/// What is added to the light of pixels, each unless null; all outlive what they are given to.
struct PixelAdditions {
    const MultipleLight* multiple = nullptr;
    const SnowLayer* snow = nullptr;
    bool snow_in_ground_truth = false;  // SnowDesc::in_ground_truth
};

/// A pixel and what it was made of.
struct RenderedPixel {
    const PixelView& view;
    const SurfaceLight& light;  // on its samples, from `first_sample` on
    std::size_t first_sample;
    const PixelResult& result;
};

/// Renders tile by tile: the surfaces that the pixels' rays hit, the in-scatter on the way, and the
/// final pixels.
class TileRenderer {
  public:
    /// `in_scatter_tolerance`: that of InScatterLattice; 0 integrates every pixel's own ray.
    TileRenderer(const PixelRenderer& renderer, double in_scatter_tolerance,
                 const PixelAdditions& additions = {});

    /// Traces the whole tile, even if only part of it is rendered: its lattice depends on all of
    /// it, and its surfaces are lit in one batch.
    void begin(const PixelWindow& tile);

    /// Renders a pixel of the tile; the result refers to storage of the renderer's.
    RenderedPixel render(int x, int y);

  private:
    void add_snow(int x, int y, const PixelView& view);

    const PixelRenderer& renderer_;
    PixelAdditions additions_;
    std::optional<InScatterLattice> lattice_;  // empty: every pixel by itself
    PixelWindow tile_;
    Grid2D<PixelView> views_;                 // of the tile
    SurfaceLight light_;                      // on all their samples
    std::vector<std::size_t> first_samples_;  // index of each view's first sample in light_
    std::vector<double> in_scatter_;          // of the current pixel, if there is no lattice
    PixelResult result_;
};

}  // namespace uw
