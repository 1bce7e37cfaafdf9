#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "core/base/grid2d.h"
#include "core/image/colour.h"
#include "core/image/film.h"
#include "core/image/layers.h"
#include "core/passes/all_light_pass.h"
#include "core/passes/in_scatter_lattice.h"
#include "core/passes/pixel_renderer.h"
#include "core/passes/snow_image.h"

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

/// Receives the fraction of the pixels that are done, from any thread; returns false to stop.
using ProgressCallback = std::function<bool(double fraction)>;

/// Receives each finished pixel, from any thread.
using PixelCallback = std::function<void(int x, int y, const RenderedPixel& pixel)>;

/// Renders every pixel of the film's window on all permitted threads. The result depends neither on
/// their number nor on the window. `in_scatter_tolerance`: that of InScatterLattice; 0 integrates
/// every pixel's own ray. Throws Interrupted if `progress` returned false.
void render_film(const PixelRenderer& renderer, double in_scatter_tolerance, const LayerPlan& plan,
                 const BandColour& colour, Film& film, const ProgressCallback& progress,
                 const PixelCallback& done = {}, const PixelAdditions& additions = {});

}  // namespace uw
