#pragma once

#include <functional>

#include "core/colour/colour.h"
#include "core/frame/multiple_light.h"
#include "core/frame/pixel_renderer.h"
#include "core/frame/tile_renderer.h"
#include "core/image/film.h"
#include "core/image/layers.h"

namespace uw {

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
