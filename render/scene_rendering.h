#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
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

/// Makes the passes of an image. `frame`: its number, on which the sensor's noise depends.
PassList make_passes(const ImageScene& image, const PathRequest& paths = {},
                     std::int64_t frame = 0);

/// Throws UsageError of one line if the light of an image of this scene is not known by distance,
/// as DeepPass needs it.
void check_deep(const AssembledScene& scene);

/// Returns the layers of an image; `request` is that of LayerPlan. Throws as LayerPlan, and
/// UsageError if `paths` is requested of an integrator that does not trace paths.
LayerPlan layer_plan(const ImageScene& image, std::string_view request,
                     const PathRequest& paths = {});

/// Returns the resolution of deep shadow maps in water of `medium` for an image of this quality.
DeepShadowOptions deep_shadow_options(RenderDesc::Quality quality, const Medium& medium);

/// Returns the groups of bands with rays of their own, if the port of the camera has indices by
/// wavelength. Rays of a group may be off by a pixel in drafts, and by a tenth of a pixel
/// otherwise.
std::vector<ColourGroup> colour_groups_of(const SceneDesc& scene);

/// Returns a renderer of the pixels of `scene` by `transport`, both of which must outlive it.
/// Precondition: the scene has slabs if `parts` has the first slab.
PixelRenderer pixel_renderer(const AssembledScene& scene, const LightTransport& transport,
                             const InScatterParts& parts = {}, const PointMatchers& matchers = {});
/// The same along other rays than those of the scene's camera; they must outlive the result.
PixelRenderer pixel_renderer(const AssembledScene& scene, const RaySource& rays,
                             const LightTransport& transport, const InScatterParts& parts = {},
                             const PointMatchers& matchers = {});

/// Sets up an image of `scene` for its passes: its pixels along `rays`, such as those of the
/// scene's camera, by `transport`. All arguments must outlive the result; `light` may be empty if
/// no pass needs it.
Rendering make_rendering(const AssembledScene& scene, const RaySource& rays,
                         const LightTransport& transport,
                         std::span<const std::shared_ptr<const DeepShadow>> light,
                         const ImageTarget& target, const PointMatchers& matchers = {});

/// Returns a warning, one line, if all lamps are too far away for MultipleScatteringPass: its paths
/// begin at the camera and seldom come close to such lamps, so that a few paths carry nearly all
/// light. None if the scene is rendered otherwise.
std::optional<std::string> far_lamp_warning(const AssembledScene& scene);

}  // namespace uw
