#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "camera/lateral_colour.h"
#include "core/image/layers.h"
#include "core/passes/pass.h"
#include "core/passes/path_pass.h"
#include "media/light/deep_shadow_map.h"
#include "render/scene_assembly.h"

namespace uw {

/// The passes of an image, the only place that knows which ones it takes.
/// `frame`: its number, on which the sensor's noise depends.
PassList make_passes(const ImageScene& image, const PathRequest& paths = {},
                     std::int64_t frame = 0);

/// The layers of an image: `request` is what LayerPlan takes. Throws as it does, and UsageError if
/// `paths` is requested of an integrator that traces none.
LayerPlan layer_plan(const ImageScene& image, std::string_view request,
                     const PathRequest& paths = {});

/// The resolution at which lamps are splatted into water of `medium` for an image of this quality.
DeepShadowOptions deep_shadow_options(RenderDesc::Quality quality, const Medium& medium);

/// The bands of an image that are seen along rays of their own, if its camera's port has indices by
/// wavelength: a draft's may be off by a pixel, others by a tenth of one.
std::vector<ColourGroup> colour_groups_of(const SceneDesc& scene);

/// Renders the pixels of `scene` by `transport`, one at a time. Both outlive the result. The scene
/// has slabs if `parts` has the first.
PixelRenderer pixel_renderer(const AssembledScene& scene, const LightTransport& transport,
                             const InScatterParts& parts = {}, const PointMatchers& matchers = {});
/// The same along other rays than those of the scene's camera; they outlive the result.
PixelRenderer pixel_renderer(const AssembledScene& scene, const RaySource& rays,
                             const LightTransport& transport, const InScatterParts& parts = {},
                             const PointMatchers& matchers = {});

/// One line about lamps too far away for the fast form of multiple scattering: its paths begin at
/// the camera and seldom come near such lamps, so that few of them carry nearly all the light. None
/// where it is not what the scene is rendered by.
std::optional<std::string> far_lamp_warning(const AssembledScene& scene);

}  // namespace uw
