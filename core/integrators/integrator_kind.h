#pragma once

#include <memory>
#include <vector>

#include "core/base/affine.h"
#include "core/integrators/deep_shadow.h"
#include "core/integrators/light_transport.h"
#include "core/integrators/lit_scene.h"
#include "core/integrators/slabs.h"
#include "core/scene/scene_desc.h"

namespace uw {

/// What integrators are made from.
struct IntegratorInputs {
    LitScene scene;
    Affine world_from_camera;
    Slabs slabs;  // those of `render.planes`
    RenderDesc::Quality quality = RenderDesc::Quality::final;
    /// One per lamp; may be empty unless IntegratorKind::needs_deep_shadows.
    std::vector<std::shared_ptr<const DeepShadow>> deep_shadows;
};

/// One of the integrators that users choose from (`render.integrator`): what it needs, what it
/// refuses, and how it is made. Each integrator states its own.
struct IntegratorKind {
    /// Takes light from deep shadow maps: lamps must be splatted first.
    bool needs_deep_shadows = false;
    /// Its in-scatter may be interpolated between pixels (InScatterLattice). Not that of
    /// integrators that are there for comparison: with them every pixel has a ray of its own.
    bool interpolates_between_pixels = false;
    /// Sums over the slabs of `render.planes`, which are then the slabs of forward scatter, too.
    bool sums_slabs = false;
    /// Throws InputError for a scene that it cannot do.
    void (*check)(const SceneDesc& scene) = [](const SceneDesc&) {};
    LightTransport (*make)(const IntegratorInputs& inputs) = nullptr;
};

}  // namespace uw
