#include "render/light_splatter.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace uw {

namespace {

// Shadow maps of a lamp's emitters share the texels of a point lamp's, but have no fewer than this
// along an edge: a shadow narrower than a texel may be missed.
constexpr int k_least_shadow_resolution = 128;

}  // namespace

void LightSplatter::drop_outdated(const AssembledScene& scene, const DeepShadowOptions& share) {
    const bool same_shadows =
        surfaces_ == scene.surfaces && options_.shadow_resolution == share.shadow_resolution;
    const bool same_columns = field_.lock() == scene.field &&
                              options_.columns_per_voxel == share.columns_per_voxel &&
                              options_.column_budget == share.column_budget &&
                              options_.column_tolerance == share.column_tolerance;
    for (Maps& maps : maps_) {
        if (!same_shadows) maps.shadows.reset();
        if (!same_columns) maps.columns.reset();
    }
    surfaces_ = scene.surfaces;
    field_ = scene.field;
    options_ = share;
}

int LightSplatter::shadow_resolution(const Lamp& emitter) const {
    const auto shared = static_cast<int>(options_.shadow_resolution * std::sqrt(emitter.share()));
    return std::max(shared, std::min(options_.shadow_resolution, k_least_shadow_resolution));
}

void LightSplatter::complete(Maps& maps, const AssembledScene& scene, const DirectionCone& beam) {
    if (!maps.shadows) {
        maps.shadows =
            std::make_shared<ShadowMap>(*scene.surfaces, maps.lamp, maps.shadow_resolution, beam);
        ++counts_.shadow_maps;
        counts_.rays += maps.shadows->rays_traced();
    }
    if (!maps.columns) {
        maps.columns =
            std::make_shared<ColumnMap>(*scene.field, maps.lamp, options_.columns_per_voxel,
                                        options_.column_budget, options_.column_tolerance);
        ++counts_.column_maps;
        counts_.rays += maps.columns->rays_traced();
    }
}

DeepShadows LightSplatter::splat(const AssembledScene& scene, const DeepShadowOptions& options,
                                 const ShareCallback& progress) {
    counts_ = {};
    DeepShadowOptions share = options;
    share.column_budget /= std::max(std::size_t{1}, scene.emitters.size());
    drop_outdated(scene, share);
    std::vector<Maps> before = std::exchange(maps_, {});
    DeepShadows fields;
    for (const Lamp& emitter : scene.emitters) {
        const DirectionCone beam = emitter.cone();
        Maps maps{emitter.position(), shadow_resolution(emitter), nullptr, nullptr};
        // Lamps at the same position share their maps.
        for (const std::vector<Maps>* known : {&maps_, &before}) {
            for (const Maps& other : *known) {
                if (other.lamp != maps.lamp) continue;
                if (!maps.columns) maps.columns = other.columns;
                if (!maps.shadows && other.shadows &&
                    other.shadow_resolution == maps.shadow_resolution &&
                    other.shadows->beam().includes(beam))
                    maps.shadows = other.shadows;
            }
        }
        complete(maps, scene, beam);
        fields.push_back(std::make_shared<DeepShadowMap>(maps.shadows, maps.columns));
        maps_.push_back(std::move(maps));
        progress(static_cast<double>(fields.size()) / static_cast<double>(scene.emitters.size()));
    }
    return fields;
}

}  // namespace uw
