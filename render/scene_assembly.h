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

/// Called with the name of each stage as it begins.
using StageCallback = std::function<void(const std::string& stage)>;

/// Loads and builds what the scene of an image names, but for what is in `cache`, which keeps it
/// for the next; slabs are not placed. The result is the same to the bit as with an empty cache.
/// `particles` is told how far their scattering is computed, before the first stage begins. Throws
/// InputError and IoError of one line each.
AssembledScene assemble_scene(const ImageScene& image, SceneCache& cache,
                              const StageCallback& begin_stage,
                              const ProgressCallback& particles = {});

/// Places the slabs of an assembled scene: costs a ray through each pixel of a coarse image. Throws
/// as place_slabs.
Slabs place_slabs(const AssembledScene& scene);

/// The scene, assembled, with what moves at another moment: `then` is what ImageScene::at makes of
/// it. It shares the rest with `scene`, and has no warnings. `camera`: that of the part of the
/// exposure, made of `then`. Throws as build_surfaces.
AssembledScene with_moved(const AssembledScene& scene, ImageScene then,
                          std::unique_ptr<Camera> camera, SceneCache& cache);

/// The light transport of the integrator that the scene requests, from light splatted before;
/// `deep_shadows` may be empty unless IntegratorKind::needs_deep_shadows. In-scatter is weighted by
/// distance if the output is the paper's, and without that of the snow that is drawn. `with_paths`:
/// LightTransport::paths, too.
LightTransport make_light_transport(const AssembledScene& scene, const DeepShadows& deep_shadows,
                                    bool with_paths);

/// The light transport of the integrator path, whatever the scene requests, with exact columns.
/// `scattering`: of its water.
LightTransport make_path_transport(const AssembledScene& scene,
                                   std::shared_ptr<const ScatteringTables> scattering);

/// The optical depth, in the clearest band, that the light of the nearest lamp passes to where
/// light paths from the camera begin: the camera, or a surface in view that the lamp lights. With
/// columns of the volumes. None without lamps.
std::optional<double> depth_of_nearest_lamp(const AssembledScene& scene);

}  // namespace uw
