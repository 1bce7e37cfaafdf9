#pragma once

#include <memory>
#include <utility>

#include "core/light/integrator.h"
#include "media/light/column_map.h"
#include "media/light/shadow_map.h"

namespace uw {

/// The light of a lamp or sun, splatted into the scene: a map of the shadows of surfaces and one of
/// columns, either of which may be shared with others.
template <class Shadows, class Columns>
class SplattedLight : public DeepShadow {
  public:
    /// Both are of the same light.
    SplattedLight(std::shared_ptr<const Shadows> shadows, std::shared_ptr<const Columns> columns)
        : shadows_(std::move(shadows)), columns_(std::move(columns)) {}

    void lit_intervals(const Ray& ray, const Interval& interval,
                       std::vector<Interval>& lit) const override {
        shadows_->lit_intervals(ray, interval, lit);
    }
    void append_column_breaks(const Ray& ray, const Interval& interval,
                              std::vector<double>& s) const override {
        columns_->append_breaks(ray, interval, s);
    }
    void columns(std::span<const Point3> x, std::span<double> column) const override {
        columns_->columns(x, column);
    }
    std::size_t bytes() const override { return shadows_->bytes() + columns_->bytes(); }
    std::uint64_t rays_traced() const { return shadows_->rays_traced() + columns_->rays_traced(); }

  private:
    std::shared_ptr<const Shadows> shadows_;
    std::shared_ptr<const Columns> columns_;
};

/// The resolution at which lamps are splatted.
struct DeepShadowOptions {
    int shadow_resolution = 512;              // texels along an edge of a cube face
    double columns_per_voxel = 2;             // texels and steps of columns per voxel edge
    std::size_t column_budget = 80ull << 20;  // bytes of columns, for all lamps of a scene together
    DepthTolerance column_tolerance{};        // permits fewer where they suffice
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
