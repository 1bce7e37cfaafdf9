#pragma once

#include <memory>
#include <utility>

#include "core/integrators/deep_shadow.h"

namespace uw {

/// The light of a lamp or sun, splatted into the scene (docs/design.md): a map of the shadows of
/// surfaces and one of columns, either of which may be shared with others.
template <class Shadows, class Columns>
class SplattedLight : public DeepShadow {
  public:
    /// Both of the same light.
    SplattedLight(std::shared_ptr<const Shadows> shadows, std::shared_ptr<const Columns> columns)
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
    std::shared_ptr<const Shadows> shadows_;
    std::shared_ptr<const Columns> columns_;
};

}  // namespace uw
