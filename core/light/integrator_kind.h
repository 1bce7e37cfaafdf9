#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "core/base/vector_math.h"
#include "core/light/integrator.h"
#include "core/light/slabs.h"
#include "core/light/surface_lighting.h"
#include "core/scene/scene_desc.h"

namespace uw {

class PathTracer;

/// The estimators of the light that reaches the camera: of light scattered once by the water, of
/// light reflected once by surfaces, and of all other light.
struct LightTransport {
    std::unique_ptr<const Integrator> integrator;
    std::unique_ptr<const SurfaceLighting> surfaces;
    /// What `integrator` integrates, in parts that are interpolated between pixels separately: the
    /// light of suns that waves focus varies from pixel to pixel, all other light is smooth. Empty:
    /// `integrator` is interpolated as a whole.
    std::vector<std::unique_ptr<const Integrator>> parts{};
    /// Traces random paths: for all light (IntegratorKind::traces_paths), or for what the other two
    /// leave out (MultipleScatteringPass). Null unless a pass needs it.
    std::shared_ptr<const PathTracer> paths{};

    /// Replaces the integrator, and its parts with it.
    void replace_integrator(std::unique_ptr<const Integrator> by) {
        integrator = std::move(by);
        parts.clear();
    }
};

/// The inputs from which integrators are constructed.
struct IntegratorInputs {
    LitScene scene;
    Affine world_from_camera;
    Slabs slabs;  // as given by `render.planes`
    RenderDesc::Quality quality = RenderDesc::Quality::final;
    /// One per lamp; may be empty unless IntegratorKind::needs_deep_shadows.
    std::vector<std::shared_ptr<const DeepShadow>> deep_shadows;
};

/// One of the integrators that users can select (`render.integrator`): its requirements, the scenes
/// it rejects, and its factory. Each integrator defines its own.
struct IntegratorKind {
    /// Reads deep shadow maps: the lamps must be splatted first.
    bool needs_deep_shadows = false;
    /// Its in-scatter may be interpolated between pixels (InScatterLattice). False for the
    /// integrators that serve for comparison: they integrate every pixel's own ray.
    bool interpolates_between_pixels = false;
    /// Sums over the slabs of `render.planes`; forward scatter then uses the same slabs.
    bool sums_slabs = false;
    /// All light is rendered by random paths from the camera (PathTracer); its `samples` are theirs
    /// and have a standard error.
    bool traces_paths = false;
    /// Also renders light that is scattered or reflected more than once.
    bool multiple_scattering = false;
    int samples = 4, draft_samples = 1;  // per pixel, unless requested
    /// Throws InputError for a scene that it cannot render.
    void (*check)(const SceneDesc& scene) = [](const SceneDesc&) {};
    LightTransport (*make)(const IntegratorInputs& inputs) = nullptr;
};

}  // namespace uw
