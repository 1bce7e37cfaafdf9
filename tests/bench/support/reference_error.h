#pragma once

#include "render/scene_rendering.h"

namespace uw::bench {

/// The error of a scene's image relative to the reference integrator, on a lattice of its pixels.
/// All bands of the total radiance, relative to their mean over these pixels.
struct ReferenceError {
    int pixels = 0;
    double rmse = 0;       // root of the mean square difference
    double largest = 0;    // difference of any band of any pixel
    double reference = 0;  // the reference's own uncertainty, as an RMSE
};

/// Compares about `pixels` pixels of a rendered film, which has the layer `total` of `plan`, with
/// the reference. `step`: of the reference integrator; its own uncertainty is estimated with a
/// second one of twice the step, whose error is about double. On all cores.
ReferenceError compare_with_reference(const AssembledScene& scene, const LayerPlan& plan,
                                      const Film& film, int pixels, double step);

}  // namespace uw::bench
