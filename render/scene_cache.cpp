#include "render/scene_cache.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <variant>

#include "core/light/submerged.h"
#include "media/volumes/fluid_domain.h"
#include "media/volumes/level_set_mesh.h"
#include "media/volumes/stratified_field.h"
#include "render/snow/snow_model.h"

namespace uw {

namespace {

/// Returns the stamps of the files from which the water is read, and the phase functions of the
/// volumes' constituents.
FileStamps files_of_water(const SceneDesc& scene) {
    std::vector<std::filesystem::path> files;
    for (const NamedFile& named : scene.files)
        if (named.key->path.starts_with("water.") ||
            named.key->path.starts_with("volumes[*].grids"))
            files.push_back(named.file);
    return FileStamps(files);
}

std::vector<std::vector<GridMappingDesc>> grids_of(const SceneDesc& scene) {
    std::vector<std::vector<GridMappingDesc>> grids;
    for (const VolumeDesc& volume : scene.volumes) grids.push_back(volume.grids);
    return grids;
}

WaterModel build_water(const SceneDesc& scene, const ProgressCallback& progress) {
    WaterModel water = build_water_model(scene.water, scene.volumes, progress);
    const std::optional<SnowDesc>& snow = scene.water.snow;
    if (snow && snow->mean == SnowDesc::Mean::added) add_snow(*snow, water.medium);
    return water;
}

std::vector<std::filesystem::path> files_of(const VolumeDesc& volume) {
    std::vector<std::filesystem::path> files = files_named_by_volume(volume.file);
    files.push_back(volume.file);
    if (volume.motion) files.push_back(volume.motion->file);
    return files;
}

}  // namespace

// The water does not depend on the volumes' files, but on the meaning of their grids.
bool SceneCache::KeptWater::is_of(const SceneDesc& scene) const {
    return desc == scene.water && files.are_current() &&
           std::ranges::equal(grids, scene.volumes, {}, {}, &VolumeDesc::grids);
}

bool SceneCache::KeptVolume::is_of(const VolumeDesc& other,
                                   const std::vector<std::vector<GridLoad>>& its) const {
    return volume && desc == other && loads == its && files.are_current();
}

bool SceneCache::KeptSurfaces::is_of(const SceneDesc& scene) const {
    return geometry == scene.geometry && bands_nm == scene.water.bands_nm && files.are_current();
}

const WaterModel& SceneCache::water(const SceneDesc& scene, const ProgressCallback& progress) {
    if (!water_ || !water_->is_of(scene)) {
        FileStamps files = files_of_water(scene);
        WaterModel model = build_water(scene, progress);
        auto scattering = std::make_shared<const ScatteringTables>(model.medium);
        water_ = KeptWater{scene.water, grids_of(scene), std::move(files), std::move(model),
                           std::move(scattering)};
    }
    return water_->model;
}

void SceneCache::keep_only(const SceneDesc& scene, const WaterModel& water) {
    std::vector<KeptVolume> before = std::exchange(volumes_, {});
    bool are_the_same = before.size() == scene.volumes.size();
    for (std::size_t v = 0; v < scene.volumes.size(); ++v) {
        const bool is_kept = v < before.size() && before[v].is_of(scene.volumes[v], water.loads[v]);
        volumes_.push_back(is_kept ? std::move(before[v])
                                   : KeptVolume{scene.volumes[v], water.loads[v]});
        are_the_same = are_the_same && is_kept;
    }
    if (!are_the_same ||
        (field_ && (field_->constituent_count() != water.medium.constituent_count() ||
                    field_->strata() != water.strata)))
        field_.reset();
    if (surfaces_ && surfaces_->is_of(scene)) return;
    surfaces_.reset();
    if (ahead_ && ahead_->is_of(scene)) surfaces_ = std::exchange(ahead_, std::nullopt);
}

VolumeSet SceneCache::volumes(const SceneDesc& scene, const WaterModel& water) {
    keep_only(scene, water);
    VolumeSet set;
    for (KeptVolume& kept : volumes_) {
        if (!kept.volume) {
            kept.files = FileStamps(files_of(kept.desc));
            kept.volume = load_volume(kept.desc, kept.loads);
        }
        set.volumes.push_back(*kept.volume);
    }
    if (!field_) {
        std::vector<GridVolume> grids;
        for (const LoadedVolume& volume : set.volumes)
            grids.insert(grids.end(), volume.grids.begin(), volume.grids.end());
        field_ = make_field(std::move(grids), water.medium.constituent_count(), water.strata);
    }
    set.field = field_;
    return set;
}

SceneCache::KeptEmission SceneCache::make_emission(const VolumeDesc& desc, const SceneDesc& scene) {
    const EmissionDesc& emission = desc.emission.front();
    LoadedVolume loaded = load_light(desc);
    auto field = std::make_shared<GridField>(std::move(loaded.grids), 1);
    const Emission light(emission, scene.water.bands_nm);
    std::vector<EmissivePart> parts = divide_emission(*field, light, emission.samples);
    if (parts.empty())
        loaded.warnings.push_back(
            fmt::format("{}: '{}' gives off no light that is seen; check the unit of its values{}",
                        emission.where, emission.grid,
                        emission.stimulus ? ", and how fast the water moves" : ""));
    return {
        desc, scene.water.bands_nm, FileStamps(files_of(desc)),
        std::make_shared<EmissiveVolume>(EmissiveVolume{std::move(field), light, std::move(parts)}),
        std::move(loaded.warnings)};
}

std::vector<SceneEmission> SceneCache::emissions(const SceneDesc& scene,
                                                 std::vector<std::string>& warnings) {
    std::vector<SceneEmission> result;
    std::vector<KeptEmission> used;
    for (std::size_t lamp = 0; lamp < scene.lamps.size(); ++lamp) {
        if (!scene.lamps[lamp].emissive_volume) continue;
        const EmissiveVolumeDesc& emissive = *scene.lamps[lamp].emissive_volume;
        VolumeDesc desc = scene.volumes[emissive.volume];
        desc.grids.clear();
        desc.emission.assign(1, emissive.emission);
        const auto known = std::ranges::find_if(emissions_, [&](const KeptEmission& kept) {
            return kept.desc == desc && kept.bands_nm == scene.water.bands_nm &&
                   kept.files.are_current();
        });
        used.push_back(known != emissions_.end() ? *known : make_emission(desc, scene));
        result.push_back({lamp, used.back().volume});
        warnings.insert(warnings.end(), used.back().warnings.begin(), used.back().warnings.end());
    }
    emissions_ = std::move(used);
    return result;
}

SceneCache::KeptSurfaces SceneCache::build(const SceneDesc& scene) {
    KeptSurfaces built{scene.geometry, scene.water.bands_nm, {}, {}};
    built.set = surfaces_of_moment(scene);
    built.files = meshes_.files();
    for (const KeptLevelSet& kept : level_sets_) built.files.add(kept.files);
    return built;
}

// Returns the scene's geometry with the surfaces of level sets as meshes in memory.
std::vector<GeometryDesc> SceneCache::with_level_sets(const SceneDesc& scene,
                                                      std::vector<std::string>& warnings) {
    std::vector<GeometryDesc> geometry = scene.geometry;
    std::vector<KeptLevelSet> used;
    for (GeometryDesc& entry : geometry) {
        if (!entry.level_set) continue;
        const auto known = std::ranges::find_if(level_sets_, [&](const KeptLevelSet& kept) {
            return kept.file == entry.file && kept.desc == *entry.level_set &&
                   kept.files.are_current();
        });
        KeptLevelSet kept;
        if (known != level_sets_.end()) {
            kept = *known;
        } else {
            kept = {entry.file, *entry.level_set, FileStamps({entry.file}), {}, nullptr};
            kept.mesh = mesh_level_set(entry.file, *entry.level_set, entry.where, kept.warnings);
        }
        warnings.insert(warnings.end(), kept.warnings.begin(), kept.warnings.end());
        entry.mesh = kept.mesh;
        entry.mesh_name = entry.level_set->grid;
        used.push_back(std::move(kept));
    }
    level_sets_ = std::move(used);
    return geometry;
}

const SurfaceSet& SceneCache::surfaces(const SceneDesc& scene) {
    if (!surfaces_ || !surfaces_->is_of(scene)) surfaces_ = build(scene);
    return surfaces_->set;
}

const SurfaceSet& SceneCache::surfaces_ahead(const SceneDesc& next) {
    if (!ahead_ || !ahead_->is_of(next)) {
        ahead_.reset();
        ahead_ = build(next);
    }
    return ahead_->set;
}

SurfaceSet SceneCache::surfaces_of_moment(const SceneDesc& then) {
    SurfaceSet set;
    set.surfaces = build_surfaces(with_level_sets(then, set.warnings), then.water.bands_nm,
                                  set.warnings, meshes_);
    return set;
}

// The file of an image of waves may have changed in the meantime; other waves change with time
// alone.
bool SceneCache::KeptWaterSurface::is_of(const WaterSurfaceDesc& desc, double at) const {
    if (calm != without_waves(desc) || waves.has_value() != (desc.waves != nullptr)) return false;
    return !waves || (time == at && *waves == *desc.waves &&
                      !std::holds_alternative<HeightImageDesc>(waves->shape));
}

const WaterSurface& SceneCache::water_surface(const WaterSurfaceDesc& desc, double time) {
    if (!water_surface_ || !water_surface_->is_of(desc, time)) {
        water_surface_.reset();
        water_surface_.emplace(KeptWaterSurface{
            without_waves(desc), desc.waves ? std::optional(*desc.waves) : std::nullopt, time,
            WaterSurface(desc, time)});
    }
    return water_surface_->surface;
}

std::shared_ptr<const SunFocus> SceneCache::sun_focus(const Vector3& direction, double angle,
                                                      const SunFocus::Extent& extent,
                                                      int resolution) {
    constexpr std::size_t k_max = 4;  // maps of 50 MB
    std::vector<KeptFocus>& foci = water_surface_.value().foci;
    const auto known = std::ranges::find_if(foci, [&](const KeptFocus& kept) {
        return kept.direction == direction && kept.angle == angle && kept.extent == extent &&
               kept.resolution == resolution;
    });
    if (known != foci.end()) return known->focus;
    if (foci.size() == k_max) foci.erase(foci.begin());
    foci.push_back({direction, angle, extent, resolution,
                    std::make_shared<const SunFocus>(water_surface_->surface, direction, angle,
                                                     extent, resolution)});
    return foci.back().focus;
}

const SubmergedParts& SceneCache::submerged(
    const WaterSurfaceDesc& desc, const std::shared_ptr<const Surfaces>& surfaces,
    const std::shared_ptr<const ConcentrationField>& field) {
    const WaterSurfaceDesc calm = without_waves(desc);
    if (!submerged_ || submerged_->surface != calm || submerged_->surfaces != surfaces ||
        submerged_->field != field) {
        const WaterSurface surface(calm);
        submerged_ =
            KeptSubmerged{calm,
                          surfaces,
                          field,
                          {std::make_shared<SubmergedSurfaces>(surfaces, surface, SeenSky()),
                           std::make_shared<SubmergedField>(field, surface, false),
                           std::make_shared<SubmergedField>(field, surface, true)}};
    }
    return submerged_->parts;
}

}  // namespace uw
