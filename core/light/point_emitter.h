#pragma once

#include "core/light/emitter.h"

namespace uw {

/// The amount by which the squared distance of a point from a ray is increased where its light is
/// scattered on that ray [m^2], as if the point were offset in a fourth dimension. `patch_radius`:
/// of the disk with the area of the luminous surface that the point represents [m].
///
/// The light that a point scatters on a ray at the distance D grows as 1/D, so that each point of a
/// lamp with an extent would be visible as a bright dot. Within 3 patch radii r the squared
/// distance is D^2 + 0.36 r^2 (1 - 2.1983 D^2/r^2) (1 - D^2/(9 r^2))^2, which preserves the
/// integral of 1/D over parallel rays.
double squared_offset(const Point3& point, double patch_radius, const Ray& ray);

/// Returns the part of `interval` of `ray` that lies in the cone with this apex; of length 0 if
/// none does.
Interval beam_of(const DirectionCone& cone, const Point3& apex, const Ray& ray,
                 const Interval& interval);

/// Returns the geometry of a ray that passes a point, with its squared offset from the ray [m^2].
LampPassage passage_of(const Point3& point, double squared_offset, const Ray& ray);

/// A point with a profile: a lamp, or one of the points that represent a lamp with an extent.
class PointEmitter final : public Emitter {
  public:
    /// `patch`: the part of the luminous surface, or of an emissive volume, that it represents.
    PointEmitter(const Point3& position, LampProfile profile, std::optional<LampPatch> patch = {});

    const LampProfile& profile() const { return profile_; }

    std::string_view profile_name() const override;
    Point3 origin(const Point3& /*x*/) const override { return position_; }
    double spread(double distance) const override { return distance * distance; }
    bool contains(double distance) const override { return distance < k_lamp_radius; }
    double relative_intensity(const Vector3& v) const override;
    bool has_even_core() const override;
    bool is_soft() const override { return std::holds_alternative<SoftSpotProfile>(profile_); }
    DirectionCone cone() const override;
    Interval beam(const Ray& ray, const Interval& interval) const override;
    FineStructure fine_structure() const override;
    void append_profile_breaks(const Ray& ray, const Interval& interval,
                               std::vector<double>& s) const override;
    LampPassage passage(const Ray& ray) const override {
        return passage_of(position_, squared_offset(ray), ray);
    }
    double squared_offset(const Ray& ray) const override;
    Point3 origin_on_patch(const Point3& x, const UnitPoint& place) const override;

  private:
    bool equals(const Emitter& other) const override;

    Point3 position_;
    LampProfile profile_;
};

}  // namespace uw
