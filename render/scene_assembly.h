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
#include "media/volumes/load_volumes.h"
#include "media/water/water_model.h"
#include "render/image_scene.h"
#include "render/marine_snow.h"

namespace uw {

/// The light of every emitter of a scene, in their order.
using DeepShadows = std::vector<std::shared_ptr<const DeepShadow>>;

/// A scene description turned into the concrete parts that integrators work on.
struct AssembledScene {
    explicit AssembledScene(ImageScene of) : image(std::move(of)) {}

    ImageScene image;  // what it was made from
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

    const SceneDesc& desc() const { return image.desc(); }
    LitScene lit() const { return {&water.medium, field.get(), surfaces.get(), &emitters}; }
};

/// Called with the name of each stage as it begins.
using StageCallback = std::function<void(const std::string& stage)>;

/// Loads and builds what the scene of an image names; slabs are not placed.
/// `before`, a scene assembled earlier or none, is consumed: water, volumes and surfaces with the
/// same description are reused as they are, even if their files have changed since; the rest is
/// freed before anything is loaded. The result is the same to the bit as without `before`. Throws
/// InputError and IoError of one line each.
AssembledScene assemble_scene(const ImageScene& image, const StageCallback& begin_stage,
                              std::optional<AssembledScene> before = {});

/// Places the slabs of an assembled scene: costs a ray through each pixel of a coarse image. Throws
/// as place_slabs.
Slabs place_slabs(const AssembledScene& scene);

/// The scene, assembled, with what moves at another moment: `then` is what ImageScene::at makes of
/// it. It shares the rest with `scene`; it has nothing for a next scene to reuse, and no warnings.
/// `camera`: that of the part of the exposure, made of `then`. Throws as build_surfaces.
AssembledScene with_moved(const AssembledScene& scene, ImageScene then,
                          std::unique_ptr<Camera> camera);

/// The light transport of the integrator that the scene requests, from light splatted before;
/// `deep_shadows` may be empty unless IntegratorKind::needs_deep_shadows. In-scatter is weighted by
/// distance if the output is the paper's, and without that of the snow that is drawn.
LightTransport make_light_transport(const AssembledScene& scene, const DeepShadows& deep_shadows);

/// The same of single scattering alone, with the scene's output, by the integrator volume, in
/// another medium than the scene's, of the same constituents and phase functions, which outlives
/// the result; and with light weighted by its path.
LightTransport make_single_scattering(const AssembledScene& scene, const DeepShadows& deep_shadows,
                                      const Medium& medium, const PathWeight& path_weight);

/// The optical depth, in the clearest band, that the light of the nearest lamp passes to where
/// light paths from the camera begin: the camera, or a surface in view that the lamp lights. With
/// columns of the volumes. None without lamps.
std::optional<double> depth_of_nearest_lamp(const AssembledScene& scene);

/// One line about lamps too far away for the fast form of multiple scattering: its paths begin at
/// the camera and seldom come near such lamps, so that few of them carry nearly all the light. None
/// where it is not what the scene is rendered by.
std::optional<std::string> far_lamp_warning(const AssembledScene& scene);

}  // namespace uw
