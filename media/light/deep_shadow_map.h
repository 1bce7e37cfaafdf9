#pragma once

#include <memory>

#include "media/light/column_map.h"
#include "media/light/shadow_map.h"
#include "media/light/splatted_light.h"
#include "media/light/sun_column_map.h"
#include "media/light/sun_shadow_map.h"

namespace uw {

/// The resolution at which lamps are splatted.
struct DeepShadowOptions {
    int shadow_resolution = 512;              // texels along an edge of a cube face
    double columns_per_voxel = 2;             // texels and steps of columns per voxel edge
    std::size_t column_budget = 80ull << 20;  // bytes of columns, for all lamps of a scene together
    DepthTolerance column_tolerance{};        // of columns where fewer than those would do
};

/// One lamp's light, splatted into the scene.
class DeepShadowMap : public SplattedLight<ShadowMap, ColumnMap> {
  public:
    using SplattedLight::SplattedLight;

    /// `surfaces` must outlive the deep shadow map; `field` is only read here. The lamp has the
    /// options' whole budget to itself.
    DeepShadowMap(const ConcentrationField& field, const Surfaces& surfaces, const Point3& lamp,
                  const DeepShadowOptions& options)
        : SplattedLight(
              std::make_shared<ShadowMap>(surfaces, lamp, options.shadow_resolution),
              std::make_shared<ColumnMap>(field, lamp, options.columns_per_voxel,
                                          options.column_budget, options.column_tolerance)) {}
};

/// One sun's light, splatted into the scene.
using SunDeepShadow = SplattedLight<SunShadowMap, SunColumnMap>;

}  // namespace uw
