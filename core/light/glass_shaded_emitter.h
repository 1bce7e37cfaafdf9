#pragma once

#include <memory>
#include <optional>

#include "core/geometry/glass.h"
#include "core/light/emitter.h"

namespace uw {

/// Another emitter in a scene with glass, which its light passes in straight lines
/// (GlassOptics::transmittance): a factor on its light that differs from point to point
/// (Emitter::focus).
class GlassShadedEmitter final : public Emitter {
  public:
    /// `band`: the band whose light it emits.
    GlassShadedEmitter(std::shared_ptr<const Emitter> original,
                       std::shared_ptr<const GlassOptics> glass, std::size_t band);

    const std::shared_ptr<const Emitter>& original() const { return original_; }

    std::string_view profile_name() const override { return original_->profile_name(); }
    Point3 origin(const Point3& x) const override { return original_->origin(x); }
    double spread(double distance) const override { return original_->spread(distance); }
    bool contains(double distance) const override { return original_->contains(distance); }
    double relative_intensity(const Vector3& v) const override {
        return original_->relative_intensity(v);
    }
    double focus(const Point3& x) const override;
    void focus(const Ray& ray, std::span<const double> s, std::span<double> values) const override;
    bool is_focused() const override { return original_->is_focused(); }
    bool has_even_core() const override { return original_->has_even_core(); }
    bool is_soft() const override { return original_->is_soft(); }
    DirectionCone cone() const override { return original_->cone(); }
    FineStructure fine_structure() const override { return original_->fine_structure(); }
    Interval beam(const Ray& ray, const Interval& interval) const override {
        return original_->beam(ray, interval);
    }
    void append_profile_breaks(const Ray& ray, const Interval& interval,
                               std::vector<double>& s) const override;
    LampPassage passage(const Ray& ray) const override { return original_->passage(ray); }
    double squared_offset(const Ray& ray) const override { return original_->squared_offset(ray); }
    Point3 origin_on_patch(const Point3& x, const UnitPoint& place) const override {
        return original_->origin_on_patch(x, place);
    }
    const Sunlight* sunlight() const override { return original_->sunlight(); }
    bool is_mirrored() const override { return original_->is_mirrored(); }

  private:
    bool equals(const Emitter& other) const override;
    // The part of the ray in which glass may dim its light.
    Interval shadow(const Ray& ray, const Interval& interval) const;

    std::shared_ptr<const Emitter> original_;
    std::shared_ptr<const GlassOptics> glass_;
    std::size_t band_;
    // A sphere around all glass; none: it has no bounds.
    struct Ball {
        Point3 center;
        double radius = 0;
    };
    std::optional<Ball> ball_;
};

}  // namespace uw
