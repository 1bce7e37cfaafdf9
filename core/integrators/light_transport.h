#pragma once

#include <memory>

#include "core/integrators/integrator.h"
#include "core/integrators/surface_lighting.h"

namespace uw {

/// The two ways in which lamp light reaches the camera: scattered once by the water, or reflected
/// by surfaces.
struct LightTransport {
    std::unique_ptr<const Integrator> integrator;
    std::unique_ptr<const SurfaceLighting> surfaces;
};

}  // namespace uw
