#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/input_files.h"
#include "core/geometry/geometry_scene.h"
#include "core/light/emission.h"
#include "core/light/submerged.h"
#include "core/light/sun_focus.h"
#include "core/paths/scattering_tables.h"
#include "core/scene/scene_desc.h"
#include "core/scene/waves_desc.h"
#include "media/volumes/load_volumes.h"
#include "media/water/water_model.h"
#include "render/light_splatter.h"

namespace uw {

/// The volumes of a scene, loaded.
struct VolumeSet {
    std::vector<LoadedVolume> volumes;                // in the scene's order
    std::shared_ptr<const ConcentrationField> field;  // what they are together
};

/// The surfaces of a scene, ready for ray tracing.
struct SurfaceSet {
    std::shared_ptr<const Surfaces> surfaces;
    std::vector<std::string> warnings;  // one line each
};

/// The surfaces and concentrations below a calm water surface, and their mirror image above
/// (core/light/submerged.h).
struct SubmergedParts {
    std::shared_ptr<const Surfaces> shadow_casters;  // below a black sky
    std::shared_ptr<const ConcentrationField> field, field_with_image;
};

/// What is loaded and built for one scene and may serve the next: water, volumes, surfaces and the
/// light of lamps. What is asked for is made, unless what is kept was made of the same description
/// and of files that have not changed since (FileStamps); both are the same to the bit. The
/// volumes and surfaces of the last scene are kept, and no earlier ones.
class SceneCache {
  public:
    /// The water of a scene. Throws as build_water_model, to which `progress` goes.
    const WaterModel& water(const SceneDesc& scene, const ProgressCallback& progress = {});
    /// What light paths look up of the water asked for last.
    const std::shared_ptr<const ScatteringTables>& scattering() const { return water_->scattering; }

    /// Frees the volumes and surfaces that a scene in this water has no use for, so that there is
    /// memory for those that it has.
    void keep_only(const SceneDesc& scene, const WaterModel& water);

    /// The volumes of a scene in this water. Throws as load_volume.
    VolumeSet volumes(const SceneDesc& scene, const WaterModel& water);

    /// The light of a scene's volumes, of those lamps that are such, in their order. Appends
    /// warnings of one line each. Throws as load_volume and Emission.
    std::vector<SceneEmission> emissions(const SceneDesc& scene,
                                         std::vector<std::string>& warnings);

    /// The surfaces of a scene. Throws as build_surfaces, and so do the next two.
    const SurfaceSet& surfaces(const SceneDesc& scene);
    /// The surfaces of a scene that comes next. They are kept beside the last scene's until that
    /// scene is asked for, or until others are built ahead.
    const SurfaceSet& surfaces_ahead(const SceneDesc& next);
    /// The surfaces of a moment of an exposure. They are not kept, but the meshes of their files
    /// are.
    SurfaceSet surfaces_of_moment(const SceneDesc& then);

    /// A water surface that reflects, at a moment [s].
    const WaterSurface& water_surface(const WaterSurfaceDesc& desc, double time);
    /// How the waves of the surface asked for last focus a sun: the arguments of SunFocus.
    std::shared_ptr<const SunFocus> sun_focus(const Vector3& direction, double angle,
                                              const SunFocus::Extent& extent, int resolution);
    /// What is below that surface, calm: the same objects if it is asked for again.
    const SubmergedParts& submerged(const WaterSurfaceDesc& desc,
                                    const std::shared_ptr<const Surfaces>& surfaces,
                                    const std::shared_ptr<const ConcentrationField>& field);

    /// The light of a scene's lamps (LightSplatter::splat).
    DeepShadows light(
        const AssembledScene& scene, const DeepShadowOptions& options,
        const ProgressCallback& progress = [](double) {}) {
        return splatter_.splat(scene, options, progress);
    }
    /// Frees the light: what is asked for next is made anew.
    void drop_light() { splatter_ = {}; }
    /// What was made for the light asked for last.
    const SplatCounts& splat_counts() const { return splatter_.counts(); }

  private:
    struct KeptWater {
        WaterDesc desc;
        std::vector<std::vector<GridMappingDesc>> grids;
        FileStamps files;
        WaterModel model;
        std::shared_ptr<const ScatteringTables> scattering;

        bool is_of(const SceneDesc& scene) const;
    };
    struct KeptVolume {
        VolumeDesc desc;
        std::vector<std::vector<GridLoad>> loads;
        FileStamps files{};
        std::optional<LoadedVolume> volume{};  // none: it has not been loaded

        bool is_of(const VolumeDesc& other, const std::vector<std::vector<GridLoad>>& its) const;
    };
    struct KeptEmission {
        VolumeDesc desc;  // its one light is what emissions
        std::vector<double> bands_nm;
        FileStamps files;
        std::shared_ptr<const EmissiveVolume> volume;
        std::vector<std::string> warnings;
    };
    struct KeptSurfaces {
        std::vector<GeometryDesc> geometry;
        std::vector<double> bands_nm;
        FileStamps files;
        SurfaceSet set;

        bool is_of(const SceneDesc& scene) const;
    };

    struct KeptLevelSet {
        std::filesystem::path file;
        LevelSetDesc desc;
        FileStamps files;
        std::vector<std::string> warnings;
        std::shared_ptr<const TriangleMesh> mesh;
    };

    struct KeptFocus {
        Vector3 direction;
        double angle;
        SunFocus::Extent extent;
        int resolution;
        std::shared_ptr<const SunFocus> focus;
    };
    struct KeptWaterSurface {
        WaterSurfaceDesc calm;
        std::optional<WavesDesc> waves;
        double time;
        WaterSurface surface;
        std::vector<KeptFocus> foci{};  // of as many suns as one scene has

        bool is_of(const WaterSurfaceDesc& desc, double at) const;
    };
    struct KeptSubmerged {
        WaterSurfaceDesc surface;
        std::shared_ptr<const Surfaces> surfaces;
        std::shared_ptr<const ConcentrationField> field;
        SubmergedParts parts;
    };

    static KeptEmission make_emission(const VolumeDesc& desc, const SceneDesc& scene);
    KeptSurfaces build(const SceneDesc& scene);
    std::vector<GeometryDesc> with_level_sets(const SceneDesc& scene,
                                              std::vector<std::string>& warnings);

    std::optional<KeptWater> water_;
    std::vector<KeptVolume> volumes_;
    std::vector<KeptEmission> emissions_;
    std::shared_ptr<const ConcentrationField> field_;  // of `volumes_`; null: not made
    MeshStore meshes_;
    std::vector<KeptLevelSet> level_sets_;  // of the scene built last
    std::optional<KeptSurfaces> surfaces_, ahead_;
    std::optional<KeptWaterSurface> water_surface_;
    std::optional<KeptSubmerged> submerged_;
    LightSplatter splatter_;
};

}  // namespace uw
