#pragma once

#include <memory>

#include "core/light/directional_emitter.h"

namespace uw {

class SunFocus;

/// A sun's parallel light, focused by waves: it has their mean direction, and a factor that varies
/// from point to point.
class FocusedEmitter final : public DirectionalEmitter {
  public:
    /// `surface`: the calm water through which the light enters.
    FocusedEmitter(const WaterSurfaceDesc& surface, std::shared_ptr<const SunFocus> focus);

    double focus(const Point3& x) const override;
    void focus(const Ray& ray, std::span<const double> s, std::span<double> values) const override;
    bool is_focused() const override { return true; }
    void append_profile_breaks(const Ray& ray, const Interval& interval,
                               std::vector<double>& s) const override;

  private:
    bool equals(const Emitter& other) const override;

    std::shared_ptr<const SunFocus> focus_;
};

}  // namespace uw
