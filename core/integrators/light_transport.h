#pragma once

#include <memory>

#include "core/integrators/integrator.h"
#include "core/integrators/surface_lighting.h"

namespace uw {

/// How the light of a scene's lamps comes to the camera: scattered once by the water, and reflected
/// by surfaces.
struct LightTransport {
    std::unique_ptr<const Integrator> integrator;
    std::unique_ptr<const SurfaceLighting> surfaces;
};

}  // namespace uw
