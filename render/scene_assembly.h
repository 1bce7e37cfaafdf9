#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/light/integrator_kind.h"
#include "render/assembled_scene.h"

namespace uw {

class SceneCache;

/// Called with each stage as it begins.
using StageCallback = std::function<void(Stage stage)>;

/// Loads and builds the parts of an image's scene, apart from those in `cache`, which keeps them
/// for the next scene; slabs are not placed. The result is the same to the bit as with an empty
/// cache. `particles` receives the progress of computing scattering by particles, before the first
/// stage begins. Throws InputError and IoError of one line each.
AssembledScene assemble_scene(const ImageScene& image, SceneCache& cache,
                              const StageCallback& begin_stage,
                              const ProgressCallback& particles = {});

/// Places the slabs of an assembled scene, which takes a ray through each pixel of a coarse image.
/// Throws as place_slabs.
Slabs place_slabs(const AssembledScene& scene);

/// Returns an assembled scene at another time, whose image scene is `then` (ImageScene::at) and
/// whose camera is `camera`, made from `then` for a part of the exposure. It shares what does not
/// move with `scene`, and has no warnings. Throws as build_surfaces.
AssembledScene with_moved(const AssembledScene& scene, ImageScene then,
                          std::unique_ptr<Camera> camera, SceneCache& cache);

/// Makes the light transport of the integrator that the scene requests; `deep_shadows` may be empty
/// unless IntegratorKind::needs_deep_shadows. In-scattered light is weighted by distance if the
/// output is the paper's, and does not include that of drawn snow. `with_paths`: whether to make
/// LightTransport::paths, too.
LightTransport make_light_transport(const AssembledScene& scene, const DeepShadows& deep_shadows,
                                    bool with_paths);

/// Makes the light transport of the integrator path, whatever the scene requests, with exact
/// columns. `scattering`: the tables of the scene's water.
LightTransport make_path_transport(const AssembledScene& scene,
                                   std::shared_ptr<const ScatteringTables> scattering);

/// Returns the optical depth, in the clearest band and including volumes, from the nearest lamp to
/// the start of light paths: the camera, or a visible surface that the lamp lights. None without
/// lamps.
std::optional<double> depth_of_nearest_lamp(const AssembledScene& scene);

}  // namespace uw
