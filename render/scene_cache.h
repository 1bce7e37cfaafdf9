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
    std::shared_ptr<const ConcentrationField> field;  // all volumes together
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

/// Caches the parts of a scene that the next scene may reuse: water, volumes, surfaces and deep
/// shadow maps. A part is made when it is requested, unless the cached one was made from the same
/// description and from files that have not changed since (FileStamps); both are the same to the
/// bit. Only the volumes and surfaces of the last scene are kept.
class SceneCache {
  public:
    /// The water of a scene. Throws as build_water_model, which receives `progress`.
    const WaterModel& water(const SceneDesc& scene, const ProgressCallback& progress = {});
    /// The tables for light paths in the water that was requested last.
    const std::shared_ptr<const ScatteringTables>& scattering() const { return water_->scattering; }

    /// Frees the volumes and surfaces that a scene in this water does not use, so that there is
    /// memory for its own.
    void keep_only(const SceneDesc& scene, const WaterModel& water);

    /// The volumes of a scene in this water. Throws as load_volume.
    VolumeSet volumes(const SceneDesc& scene, const WaterModel& water);

    /// The emission of a scene's volumes, for those lamps that are emissive volumes, in their
    /// order. Appends warnings, one line each. Throws as load_volume and Emission.
    std::vector<SceneEmission> emissions(const SceneDesc& scene,
                                         std::vector<std::string>& warnings);

    /// The surfaces of a scene. This and the next two functions throw as build_surfaces.
    const SurfaceSet& surfaces(const SceneDesc& scene);
    /// The surfaces of the next scene. They are kept in addition to those of the last scene until
    /// that next scene is requested, or until others are built ahead.
    const SurfaceSet& surfaces_ahead(const SceneDesc& next);
    /// The surfaces at one time of an exposure. They are not kept, but the meshes of their files
    /// are.
    SurfaceSet surfaces_of_moment(const SceneDesc& then);

    /// A reflecting water surface at a `time` [s].
    const WaterSurface& water_surface(const WaterSurfaceDesc& desc, double time);
    /// How the waves of the surface that was requested last focus a sun. The arguments are those of
    /// SunFocus.
    std::shared_ptr<const SunFocus> sun_focus(const Vector3& direction, double angle,
                                              const SunFocus::Extent& extent, int resolution);
    /// The surfaces and field below that surface when it is calm; the same objects if they are
    /// requested again.
    const SubmergedParts& submerged(const WaterSurfaceDesc& desc,
                                    const std::shared_ptr<const Surfaces>& surfaces,
                                    const std::shared_ptr<const ConcentrationField>& field);

    /// The deep shadow maps of a scene's lamps (LightSplatter::splat).
    DeepShadows light(
        const AssembledScene& scene, const DeepShadowOptions& options,
        const ProgressCallback& progress = [](double) {}) {
        return splatter_.splat(scene, options, progress);
    }
    /// Frees the deep shadow maps: the next ones are made anew.
    void drop_light() { splatter_ = {}; }
    /// The maps made for the light that was requested last.
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
        std::optional<LoadedVolume> volume{};  // none: not loaded yet

        bool is_of(const VolumeDesc& other, const std::vector<std::vector<GridLoad>>& its) const;
    };
    struct KeptEmission {
        VolumeDesc desc;  // with a single entry of `emission`
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
        std::vector<KeptFocus> foci{};  // of the suns of one scene

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
    std::shared_ptr<const ConcentrationField> field_;  // of `volumes_`; null: not made yet
    MeshStore meshes_;
    std::vector<KeptLevelSet> level_sets_;  // of the last scene
    std::optional<KeptSurfaces> surfaces_, ahead_;
    std::optional<KeptWaterSurface> water_surface_;
    std::optional<KeptSubmerged> submerged_;
    LightSplatter splatter_;
};

}  // namespace uw
