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
    /// All light by random paths (IntegratorKind::traces_paths); null: the image is made of the
    /// other two.
    std::shared_ptr<const PathTracer> paths{};
};

}  // namespace uw
