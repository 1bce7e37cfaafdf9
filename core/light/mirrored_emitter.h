#pragma once

#include <memory>

#include "core/geometry/water_surface.h"
#include "core/light/point_emitter.h"

namespace uw {

/// The mirror image of an emitter with a position below calm water: light that reaches a point
/// after its reflection at the surface comes straight from the image, with the intensity that the
/// image has in that direction (reflectance included).
class MirroredEmitter final : public Emitter {
  public:
    MirroredEmitter(std::shared_ptr<const Emitter> original, const WaterSurface& surface);

    std::string_view profile_name() const override { return original_->profile_name(); }
    Point3 origin(const Point3& /*x*/) const override { return position_; }
    double spread(double distance) const override { return original_->spread(distance); }
    bool contains(double distance) const override { return original_->contains(distance); }
    double relative_intensity(const Vector3& v) const override;
    bool has_even_core() const override { return false; }
    bool is_soft() const override { return original_->is_soft(); }
    DirectionCone cone() const override;
    Interval beam(const Ray& ray, const Interval& interval) const override {
        return beam_of(cone(), position_, ray, interval);
    }
    FineStructure fine_structure() const override;
    void append_profile_breaks(const Ray& ray, const Interval& interval,
                               std::vector<double>& s) const override;
    LampPassage passage(const Ray& ray) const override {
        return passage_of(position_, squared_offset(ray), ray);
    }
    double squared_offset(const Ray& ray) const override {
        return original_->squared_offset(surface_.mirrored(ray));
    }
    Point3 origin_on_patch(const Point3& x, const UnitPoint& place) const override {
        return surface_.mirrored(original_->origin_on_patch(x, place));
    }
    bool is_mirrored() const override { return true; }

  private:
    bool equals(const Emitter& other) const override;

    std::shared_ptr<const Emitter> original_;
    WaterSurface surface_;
    Point3 position_;  // of the image
};

}  // namespace uw
