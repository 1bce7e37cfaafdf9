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
#include "render/marine_snow.h"

namespace uw {

/// The light of every emitter of a scene, in their order.
using DeepShadows = std::vector<std::shared_ptr<const DeepShadow>>;

/// A scene description turned into the concrete parts that integrators work on.
struct AssembledScene {
    explicit AssembledScene(ImageScene of) : image(std::move(of)) {}

    ImageScene image;  // what it was made from
    std::unique_ptr<Camera> camera;
    WaterModel water;                                    // its coefficients hold the snow's mean
    std::shared_ptr<const ScatteringTables> scattering;  // of the water; null: not made
    std::shared_ptr<const SnowModel> snow;               // null: there is none
    std::shared_ptr<const ConcentrationField> field;
    std::shared_ptr<const Surfaces> surfaces;
    /// The same as far as it casts shadows: below calm water and a black sky, so that it is the
    /// same object while waves move and the sky brightens.
    std::shared_ptr<const Surfaces> shadow_casters;
    std::optional<Sky> sky;                     // above the water; none: it is black
    std::optional<WaterSurface> water_surface;  // which reflects; none: the water has no end
    /// With it, the field and its mirror image above (SubmergedField).
    std::shared_ptr<const ConcentrationField> field_with_image;
    /// How waves focus each sun, by its lamp's index; null: they do not.
    std::vector<std::shared_ptr<const SunFocus>> sun_foci;
    std::vector<Lamp> lamps;                 // as the description has them, each at its centre
    std::vector<Lamp> emitters;              // the points that they consist of (LitScene::emitters)
    std::vector<LampSurface> lamp_surfaces;  // of those with an extent
    std::vector<SceneEmission> emissions;    // those that are the light of volumes
    std::optional<Slabs> slabs;              // none: they have not been placed (place_slabs)
    /// The samples of a part of an exposure (render/exposure.h); 0: all of it.
    int first_sample = 0, total_samples = 0;
    std::vector<VolumeReport> volume_reports;
    std::vector<std::string> warnings;           // one line each, in the order met
    std::vector<LoadedVolume> volumes;           // what `field` is made of
    std::vector<std::string> geometry_warnings;  // those among `warnings` about surfaces

    const SceneDesc& desc() const { return image.desc(); }
    LitScene lit() const {
        return {&water.medium,
                field.get(),
                surfaces.get(),
                &emitters,
                lamp_surfaces.empty() ? nullptr : &lamp_surfaces,
                emissions.empty() ? nullptr : &emissions,
                water_surface ? &*water_surface : nullptr};
    }
};

}  // namespace uw
