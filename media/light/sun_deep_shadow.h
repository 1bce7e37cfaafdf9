#pragma once

#include <memory>
#include <utility>

#include "core/integrators/deep_shadow.h"
#include "media/light/sun_column_map.h"
#include "media/light/sun_shadow_map.h"

namespace uw {

/// A sun's light, splatted into the scene: what a DeepShadowMap is for a lamp.
class SunDeepShadow final : public DeepShadow {
  public:
    /// Both for the same sun.
    SunDeepShadow(std::shared_ptr<const SunShadowMap> shadows,
                  std::shared_ptr<const SunColumnMap> columns)
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

  private:
    std::shared_ptr<const SunShadowMap> shadows_;
    std::shared_ptr<const SunColumnMap> columns_;
};

}  // namespace uw
