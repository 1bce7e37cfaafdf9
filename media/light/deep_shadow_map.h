#pragma once

#include <memory>
#include <utility>

#include "core/integrators/deep_shadow.h"
#include "media/light/column_map.h"
#include "media/light/shadow_map.h"

namespace uw {

/// The resolution at which lamps are splatted.
struct DeepShadowOptions {
    int shadow_resolution = 512;              // texels along an edge of a cube face
    double columns_per_voxel = 2;             // texels and steps of columns per voxel edge
    std::size_t column_budget = 80ull << 20;  // bytes of columns, for all lamps of a scene together
    DepthTolerance column_tolerance{};        // of columns where fewer than those would do
};

/// One lamp's light, splatted into the scene (docs/design.md): a shadow map and a column map,
/// either of which may be shared with other deep shadow maps.
class DeepShadowMap : public DeepShadow {
  public:
    /// `surfaces` must outlive the deep shadow map; `field` is only read here. The lamp has the
    /// options' whole budget to itself.
    DeepShadowMap(const ConcentrationField& field, const Surfaces& surfaces, const Point3& lamp,
                  const DeepShadowOptions& options)
        : DeepShadowMap(
              std::make_shared<ShadowMap>(surfaces, lamp, options.shadow_resolution),
              std::make_shared<ColumnMap>(field, lamp, options.columns_per_voxel,
                                          options.column_budget, options.column_tolerance)) {}

    /// From existing maps, both for the same lamp position.
    DeepShadowMap(std::shared_ptr<const ShadowMap> shadows,
                  std::shared_ptr<const ColumnMap> columns)
        : shadows_(std::move(shadows)), columns_(std::move(columns)) {}

    void lit_intervals(const Ray& ray, const Interval& stretch,
                       std::vector<Interval>& lit) const override {
        shadows_->lit_intervals(ray, stretch, lit);
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
    std::shared_ptr<const ShadowMap> shadows_;
    std::shared_ptr<const ColumnMap> columns_;
};

}  // namespace uw
