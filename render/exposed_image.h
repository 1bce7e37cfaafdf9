#pragma once

#include <functional>

#include "core/colour/colour.h"
#include "core/image/film.h"
#include "core/image/layers.h"
#include "render/exposure.h"
#include "render/scene_rendering.h"

namespace uw {

/// Makes the light of the lamps of a part of an exposure, if its integrator needs any.
using LightOfPart = std::function<DeepShadows(const AssembledScene& part)>;

/// Renders `scene`, of which something moves while it is exposed, into `film`, whose values are 0:
/// the light as the mean over the exposure's parts, the ground truth that of the middle, or with a
/// rolling shutter of the middle of each row's exposure. All of it is the stage "render". `film`
/// has the window that render_scene needs, `transport` is that of `scene`; the rest is as there.
void render_exposure(const Exposure& exposure, const AssembledScene& scene,
                     const LightTransport& transport, const LightOfPart& light_of_part,
                     const LayerPlan& plan, const BandColour& colour, Film& film,
                     const RenderProgress& progress, const ImageCallbacks& reached,
                     const PointMatchers& matchers);

}  // namespace uw
