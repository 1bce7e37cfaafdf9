#include "render/light_splatter.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "core/base/available_memory.h"
#include "core/base/error.h"
#include "core/light/medium.h"

namespace uw {

namespace {

// The emitters of a lamp divide the texels of a point lamp's shadow map among theirs, but have at
// least this many along an edge, as a shadow narrower than a texel may be missed.
constexpr int k_min_shadow_resolution = 128;
// The optical depth from the camera beyond which a sun's shadows in the water do not matter.
constexpr double k_max_shadow_depth = 15;

}  // namespace

void LightSplatter::drop_outdated(const AssembledScene& scene, const DeepShadowOptions& options) {
    const bool same_shadows = surfaces_ == scene.shadow_casters &&
                              options_.shadow_resolution == options.shadow_resolution;
    const bool same_columns = field_.lock() == scene.field &&
                              options_.columns_per_voxel == options.columns_per_voxel &&
                              options_.column_budget == options.column_budget &&
                              options_.column_tolerance == options.column_tolerance;
    const auto drop = [&](auto& maps) {
        if (!same_shadows) maps.shadows.reset();
        if (!same_columns) maps.columns.reset();
    };
    std::ranges::for_each(maps_, drop);
    std::ranges::for_each(sun_maps_, drop);
    surfaces_ = scene.shadow_casters;
    field_ = scene.field;
    options_ = options;
}

int LightSplatter::shadow_resolution(const Lamp& emitter) const {
    const auto resolution =
        static_cast<int>(options_.shadow_resolution * std::sqrt(emitter.fraction()));
    return std::max(resolution, std::min(options_.shadow_resolution, k_min_shadow_resolution));
}

void LightSplatter::complete(Maps& maps, const AssembledScene& scene, const Lamp& emitter) {
    const DirectionCone beam = emitter.cone();
    const ConcentrationField& field =
        emitter.is_mirrored() ? *scene.field_with_image : *scene.field;
    if (!maps.shadows) {
        maps.shadows = std::make_shared<ShadowMap>(*scene.shadow_casters, maps.lamp,
                                                   maps.shadow_resolution, beam);
        ++counts_.shadow_maps;
        counts_.rays += maps.shadows->rays_traced();
        counts_.bytes += maps.shadows->bytes();
    }
    if (!maps.columns) {
        maps.columns =
            std::make_shared<ColumnMap>(field, maps.lamp, options_.columns_per_voxel,
                                        options_.column_budget, options_.column_tolerance);
        ++counts_.column_maps;
        counts_.rays += maps.columns->rays_traced();
        counts_.bytes += maps.columns->bytes();
    }
}

DeepShadows LightSplatter::splat(const AssembledScene& scene, const DeepShadowOptions& options,
                                 const ProgressCallback& progress) {
    counts_ = {};
    DeepShadowOptions per_emitter = options;
    per_emitter.column_budget /= std::max(std::size_t{1}, scene.emitters.size());
    drop_outdated(scene, per_emitter);
    const std::vector<Maps> before = std::exchange(maps_, {});
    const std::vector<SunMaps> suns_before = std::exchange(sun_maps_, {});
    DeepShadows fields;
    for (const Lamp& emitter : scene.emitters) {
        fields.push_back(emitter.sunlight() ? splat_sun(scene, emitter, suns_before)
                                            : splat_lamp(scene, emitter, before));
        expect_room(fields.size(), scene.emitters.size());
        progress(static_cast<double>(fields.size()) / static_cast<double>(scene.emitters.size()));
        throw_if_stopped();
    }
    return fields;
}

// Checks for free memory whenever the number of maps has doubled, as if the remaining ones were as
// large as those so far.
void LightSplatter::expect_room(std::size_t done, std::size_t all) const {
    if (!std::has_single_bit(done)) return;
    const double remaining_ratio = static_cast<double>(all - done) / static_cast<double>(done);
    require_memory(static_cast<double>(counts_.bytes) * remaining_ratio,
                   fmt::format("lamps: what {} points of light see takes another", all),
                   "use fewer lamps, fewer `samples` of those with an extent, or --quality draft");
}

std::shared_ptr<const DeepShadow> LightSplatter::splat_lamp(const AssembledScene& scene,
                                                            const Lamp& emitter,
                                                            const std::vector<Maps>& before) {
    const DirectionCone beam = emitter.cone();
    Maps maps{emitter.position(), shadow_resolution(emitter), nullptr, nullptr};
    // Lamps at the same position share their maps.
    for (const std::vector<Maps>* known : {&std::as_const(maps_), &before}) {
        for (const Maps& other : *known) {
            if (other.lamp != maps.lamp) continue;
            if (!maps.columns) maps.columns = other.columns;
            if (!maps.shadows && other.shadows &&
                other.shadow_resolution == maps.shadow_resolution &&
                other.shadows->beam().includes(beam))
                maps.shadows = other.shadows;
        }
    }
    complete(maps, scene, emitter);
    maps_.push_back(maps);
    return std::make_shared<DeepShadowMap>(maps.shadows, maps.columns);
}

std::shared_ptr<const DeepShadow> LightSplatter::splat_sun(const AssembledScene& scene,
                                                           const Lamp& emitter,
                                                           const std::vector<SunMaps>& before) {
    const Sunlight& sun = *emitter.sunlight();
    const AttenuationTable attenuation(scene.water.medium);
    const double least =
        attenuation.uniform.least(static_cast<std::size_t>(attenuation.band_count));
    const double max_distance = least > 0 ? std::min(k_far, k_max_shadow_depth / least) : k_far;
    const Point3 camera = at_origin_plus(scene.camera->world_from_camera().offset());
    SunMaps maps{sun, shadow_resolution(emitter),
                 SunShadowMap::squares_around(camera, max_distance, scene.surfaces->bounds(), sun),
                 nullptr, nullptr};
    for (const std::vector<SunMaps>* known : {&std::as_const(sun_maps_), &before}) {
        for (const SunMaps& other : *known) {
            if (other.sun != sun) continue;
            if (!maps.columns) maps.columns = other.columns;
            if (!maps.shadows && other.squares == maps.squares &&
                other.shadow_resolution == maps.shadow_resolution)
                maps.shadows = other.shadows;
        }
    }
    if (!maps.shadows) {
        maps.shadows = std::make_shared<SunShadowMap>(*scene.shadow_casters, sun, maps.squares,
                                                      maps.shadow_resolution);
        ++counts_.shadow_maps;
        counts_.rays += maps.shadows->rays_traced();
        counts_.bytes += maps.shadows->bytes();
    }
    if (!maps.columns) {
        maps.columns =
            std::make_shared<SunColumnMap>(*scene.field, sun, options_.columns_per_voxel,
                                           options_.column_budget, options_.column_tolerance);
        ++counts_.column_maps;
        counts_.rays += maps.columns->rays_traced();
        counts_.bytes += maps.columns->bytes();
    }
    sun_maps_.push_back(maps);
    return std::make_shared<SunDeepShadow>(maps.shadows, maps.columns);
}

}  // namespace uw
