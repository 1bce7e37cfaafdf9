#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "camera/camera.h"
#include "core/geometry/geometry_scene.h"
#include "core/light/integrator.h"
#include "core/light/integrator_kind.h"
#include "core/light/slabs.h"
#include "core/scene/scene_desc.h"
#include "media/volumes/load_volumes.h"
#include "media/water/water_model.h"
#include "render/marine_snow.h"

namespace uw {

/// The light of every emitter of a scene, in their order.
using DeepShadows = std::vector<std::shared_ptr<const DeepShadow>>;

/// A scene description turned into the concrete parts that integrators work on.
struct AssembledScene {
    SceneDesc desc;  // what it was made from, resolved
    std::unique_ptr<Camera> camera;
    WaterModel water;                       // its coefficients hold the snow's mean
    std::shared_ptr<const SnowModel> snow;  // null: there is none
    std::shared_ptr<const ConcentrationField> field;
    std::shared_ptr<const Surfaces> surfaces;
    std::vector<Lamp> lamps;     // as the description has them, each at its centre
    std::vector<Lamp> emitters;  // the points that they consist of (LitScene::emitters)
    std::optional<Slabs> slabs;  // none: they have not been placed (place_slabs)
    /// Of a part of an exposure (render/exposure.h); 0: all of it.
    int first_sample = 0, total_samples = 0;
    std::vector<VolumeReport> volume_reports;
    std::vector<std::string> warnings;  // one line each, in the order met

    // For the next scene to reuse.
    std::vector<LoadedVolume> volumes;  // what `field` is made of
    std::vector<std::string> geometry_warnings;
    std::shared_ptr<MeshStore> meshes;  // of `surfaces`

    LitScene lit() const { return {&water.medium, field.get(), surfaces.get(), &emitters}; }
};

/// Called with the name of each stage as it begins.
using StageCallback = std::function<void(const std::string& stage)>;

/// Loads and builds what `desc`, that of a resolved scene, names; slabs are not placed. `desc` of
/// the result is left empty for the caller to move the description into: it is never copied.
/// `before`, a scene assembled earlier or an empty one, is consumed: water, volumes and surfaces
/// with the same description are reused as they are, even if their files have changed since; the
/// rest is freed before anything is loaded. The result is the same to the bit as without `before`.
/// Throws InputError and IoError of one line each.
AssembledScene assemble_scene(const SceneDesc& desc, const StageCallback& begin_stage,
                              AssembledScene before);
/// The same without a scene before it.
AssembledScene assemble_scene(const SceneDesc& desc, const StageCallback& begin_stage);

/// Places the slabs of an assembled scene: costs a ray through each pixel of a coarse image. Throws
/// as place_slabs.
Slabs place_slabs(const AssembledScene& scene);

/// The scene, assembled, with what moves at another moment: `desc` is what scene_at makes of its
/// description. It shares the rest with `scene`; it has nothing for a next scene to reuse, and no
/// warnings. `camera`: that of the part of the exposure, made of `desc`. Throws as build_surfaces.
AssembledScene with_moved(const AssembledScene& scene, SceneDesc desc,
                          std::unique_ptr<Camera> camera);

/// The light transport of the integrator that the scene requests, from light splatted before;
/// `deep_shadows` may be empty unless IntegratorKind::needs_deep_shadows. In-scatter is weighted by
/// distance if the output is the paper's, and without that of the snow that is drawn. `with_paths`:
/// LightTransport::paths, too.
LightTransport make_light_transport(const AssembledScene& scene, const DeepShadows& deep_shadows,
                                    bool with_paths);

/// The same of single scattering alone, with the scene's output, by the integrator volume, in
/// another medium than the scene's, of the same constituents and phase functions, which outlives
/// the result; and with light weighted by its path.
LightTransport make_single_scattering(const AssembledScene& scene, const DeepShadows& deep_shadows,
                                      const Medium& medium, const PathWeight& path_weight);

/// The optical depth, in the clearest band, that the light of the nearest lamp passes to where
/// light paths from the camera begin: the camera, or a surface in view that the lamp lights. With
/// columns of the volumes. None without lamps.
std::optional<double> depth_of_nearest_lamp(const AssembledScene& scene);

}  // namespace uw
