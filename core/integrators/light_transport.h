#pragma once

#include <memory>

#include "core/integrators/integrator.h"
#include "core/integrators/surface_lighting.h"

namespace uw {

class PathTracer;

/// The ways in which lamp light reaches the camera: scattered once by the water, reflected once by
/// surfaces, or any other.
struct LightTransport {
    std::unique_ptr<const Integrator> integrator;
    std::unique_ptr<const SurfaceLighting> surfaces;
    /// Random paths: of all light (IntegratorKind::traces_paths), or of what the other two leave
    /// out (MultipleLight). Null for single scattering.
    std::shared_ptr<const PathTracer> paths{};
};

}  // namespace uw
