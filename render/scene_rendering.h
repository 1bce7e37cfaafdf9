#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/image/colour.h"
#include "core/image/film.h"
#include "core/image/layers.h"
#include "core/passes/forward_pass.h"
#include "core/passes/path_film.h"
#include "media/light/deep_shadow_map.h"
#include "render/scene_assembly.h"

namespace uw {

/// Receives the progress of a stage (0..1), on any thread; returns false to stop.
using RenderProgress = std::function<bool(const std::string& stage, double fraction)>;

/// What is requested of an image that is rendered by light paths (IntegratorKind::traces_paths).
struct PathRequest {
    std::optional<double> error{};  // PathGoal::error, instead of the scene's samples
    int orders = 0;                 // LayerSupply::orders

    friend bool operator==(const PathRequest&, const PathRequest&) = default;
};

/// The layers of an image: `request` is what LayerPlan takes. Throws as it does, and UsageError if
/// `paths` is requested of an integrator that traces none.
LayerPlan layer_plan(const ImageScene& image, std::string_view request,
                     const PathRequest& paths = {});

/// Whether an image of these layers has to do with slabs: some layer, its integrator or its forward
/// scatter, or the scene says where they are, which may be where no water is.
bool needs_slabs(const SceneDesc& scene, const LayerPlan& plan);

/// The resolution at which lamps are splatted into water of `medium` for an image of this quality.
DeepShadowOptions deep_shadow_options(RenderDesc::Quality quality, const Medium& medium);

/// How closely in-scatter is interpolated between pixels (InScatterLattice); 0 for integrators
/// meant for comparison: every pixel has its own ray.
double in_scatter_tolerance(const RenderDesc& render);

/// Renders the pixels of `scene` by `transport`, one at a time. Both outlive the result. The scene
/// has slabs if `parts` has the first.
PixelRenderer pixel_renderer(const AssembledScene& scene, const LightTransport& transport,
                             const InScatterParts& parts = {}, const PointMatchers& matchers = {});

/// Whom to tell about an image while it is made; each may be empty.
struct ImageCallbacks {
    AccuracyCallback paths{};                            // of an image of light paths, so far
    std::function<void(double error)> multiple{};        // MultipleLight::error, before "render"
    std::function<void(std::size_t count)> particles{};  // of snow, before "render"
};

/// Renders `scene` into `film` by `transport`: the stage "snow", if there is snow, the stage
/// "render", and, with forward scatter on,
/// the stage "forward scatter", for which the film's window must be the whole image.
/// A transport that has paths is rendered by them until `goal` is reached, if the integrator traces
/// paths; else they estimate what it leaves out, in a stage "multiple scattering" before "render".
/// `progress` receives each with 0 before it begins. Throws Interrupted if it returned false;
/// InputError if there is not enough memory.
void render_scene(const AssembledScene& scene, const DeepShadows& deep_shadows,
                  const LightTransport& transport, const LayerPlan& plan, const BandColour& colour,
                  Film& film, const RenderProgress& progress, const PathGoal& goal = {},
                  const ImageCallbacks& reached = {}, const PointMatchers& matchers = {});

/// How the light of `scene` is scattered forward. If the integrator sums slabs the water is split
/// into them, else into slabs that grow with the distance. `scene` has its slabs placed; it and
/// `deep_shadows` outlive the result.
ForwardScatterSetup forward_scatter_setup(const AssembledScene& scene,
                                          const DeepShadows& deep_shadows);

}  // namespace uw
