#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "camera/camera.h"
#include "core/geometry/surfaces.h"
#include "core/geometry/water_surface.h"
#include "core/light/integrator.h"
#include "core/light/lamps_in_view.h"
#include "core/light/sky.h"
#include "core/light/slabs.h"
#include "core/light/sun_focus.h"
#include "core/paths/scattering_tables.h"
#include "media/volumes/load_volumes.h"
#include "media/water/water_model.h"
#include "render/image_scene.h"
#include "render/snow/snow_model.h"

namespace uw {

class GlassOptics;

/// The deep shadow maps of the emitters of a scene, in their order.
using DeepShadows = std::vector<std::shared_ptr<const DeepShadow>>;

/// The parts of a scene that integrators work on, made from its description (assemble_scene). A
/// scene with a part that no description has, such as water with a measured phase function, is a
/// copy with another part, which shares all others (Renderer::set_scene). Where the water differs,
/// `scattering` has to be null.
struct AssembledScene {
    explicit AssembledScene(ImageScene of) : image(std::move(of)) {}

    ImageScene image;  // the scene from which it was made
    std::shared_ptr<const Camera> camera;
    WaterModel water;                                    // its coefficients include the snow's mean
    std::shared_ptr<const ScatteringTables> scattering;  // of the water; null: not made yet
    std::shared_ptr<const SnowModel> snow;               // null without snow
    std::shared_ptr<const ConcentrationField> field;
    std::shared_ptr<const Surfaces> surfaces;
    /// The surfaces for shadows, below calm water and a black sky, so that it is the same object
    /// while waves move and the sky changes.
    std::shared_ptr<const Surfaces> shadow_casters;
    std::shared_ptr<const GlassOptics> glass;   // of the surfaces; null: none is of glass
    std::optional<Sky> sky;                     // above the water; none: black
    std::optional<WaterSurface> water_surface;  // reflects; none: the water is unbounded
    /// The field and its mirror image above the water surface, if there is one (SubmergedField).
    std::shared_ptr<const ConcentrationField> field_with_image;
    /// The focusing of each sun by waves, by the lamp's index; null without focusing.
    std::vector<std::shared_ptr<const SunFocus>> sun_foci;
    std::vector<Lamp> lamps;     // those of the description, each as a point at its centre
    std::vector<Lamp> emitters;  // the points that represent them (LitScene::emitters)
    std::vector<LampSurface> lamp_surfaces;  // of those with an extent
    std::vector<SceneEmission> emissions;    // those of emissive volumes
    std::optional<Slabs> slabs;              // none: not placed yet (place_slabs)
    /// The samples of a part of an exposure (render/exposure.h); 0 if the image is no part.
    int first_sample = 0, total_samples = 0;
    std::vector<VolumeReport> volume_reports;
    std::vector<std::string> warnings;           // one line each, in the order of their occurrence
    std::vector<LoadedVolume> volumes;           // those of which `field` consists
    std::vector<std::string> geometry_warnings;  // the warnings that are about surfaces

    const SceneDesc& desc() const { return image.desc(); }
    LitScene lit() const {
        return {&water.medium,
                field.get(),
                surfaces.get(),
                &emitters,
                lamp_surfaces.empty() ? nullptr : &lamp_surfaces,
                emissions.empty() ? nullptr : &emissions,
                water_surface ? &*water_surface : nullptr,
                glass.get()};
    }
};

}  // namespace uw
