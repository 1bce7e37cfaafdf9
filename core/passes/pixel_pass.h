#pragma once

#include <functional>
#include <span>

#include "core/image/film.h"
#include "core/passes/pass.h"
#include "core/passes/pixel_renderer.h"

namespace uw {

/// Returns the tolerance with which in-scattered light is interpolated between pixels
/// (InScatterLattice); 0, which integrates every pixel's own ray, for integrators that are meant
/// for comparison.
double in_scatter_tolerance(const RenderDesc& render);

/// Receives each finished pixel, from any thread.
using PixelCallback = std::function<void(int x, int y, const PixelResult& pixel)>;

/// Renders every pixel of a window of the image on all permitted threads, tile by tile: traces rays
/// to surfaces, lights these, integrates in-scattering, and applies `steps` (Rendering). The pixels
/// depend neither on the number of threads nor on the window. `in_scatter_tolerance`: that of
/// InScatterLattice; 0 integrates every pixel's own ray. Throws Interrupted.
void render_tiles(const PixelRenderer& renderer, double in_scatter_tolerance,
                  std::span<const PixelStep> steps, const PixelWindow& window,
                  const ProgressCallback& progress, const PixelCallback& done);

/// Renders the pixels of the film's window by single scattering and the steps of other passes.
class PixelPass final : public Pass {
  public:
    explicit PixelPass(const RenderDesc& render);

    PassNeeds needs(const LayerPlan& plan) const override;
    void run(Rendering& rendering) override;

  private:
    double in_scatter_tolerance_;
    bool needs_light_, needs_slabs_;
};

}  // namespace uw
