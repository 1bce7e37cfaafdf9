#pragma once

#include "core/light/emitter.h"
#include "core/light/sunlight.h"

namespace uw {

/// Parallel light that begins at the water's surface: a sun, or one of the directions that
/// represent a sun's disc or the sky.
class DirectionalEmitter : public Emitter {
  public:
    /// `patch`: the part of the disc, or of the sky, that it represents.
    explicit DirectionalEmitter(const Sunlight& sunlight, std::optional<LampPatch> patch = {});

    std::string_view profile_name() const override { return "sun"; }
    Point3 origin(const Point3& x) const override { return sunlight_.entry(x); }
    double spread(double /*distance*/) const override { return 1; }
    bool contains(double /*distance*/) const override { return false; }
    double relative_intensity(const Vector3& v) const override {
        return glm::dot(v, sunlight_.direction) > 0 ? 1 : 0;
    }
    bool has_even_core() const override { return true; }
    DirectionCone cone() const override { return {}; }
    Interval beam(const Ray& ray, const Interval& interval) const override;
    void append_profile_breaks(const Ray& ray, const Interval& interval,
                               std::vector<double>& s) const override;
    LampPassage passage(const Ray& ray) const override;
    Point3 origin_on_patch(const Point3& x, const UnitPoint& place) const override;
    const Sunlight* sunlight() const override { return &sunlight_; }

  protected:
    bool equals(const Emitter& other) const override;

  private:
    Sunlight sunlight_;
};

}  // namespace uw
