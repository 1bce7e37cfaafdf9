#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/ray.h"
#include "core/base/spectrum.h"
#include "core/base/vector_math.h"
#include "core/geometry/water_surface.h"
#include "core/light/emitter.h"
#include "core/light/sunlight.h"

namespace uw {

class GlassOptics;
class SunFocus;

/// An emitter in a scene, and how bright it is: a lamp of the scene, or one of the points or
/// directions that represent a lamp with an extent, a sun's disc or the sky
/// (core/light/lamp_factory.h).
class Lamp {
  public:
    /// `axis_intensity`: radiant intensity per band where the emitter's relative intensity is 1
    /// [W/sr]; for parallel light, irradiance on a plane perpendicular to it, at the water's
    /// surface [W/m^2]. `index`: which of the scene's lamps it belongs to. `fraction`: the
    /// part of that lamp's light that it represents.
    Lamp(std::string name, std::shared_ptr<const Emitter> emitter, const Spectrum& axis_intensity,
         std::size_t index = 0, double fraction = 1);
    /// A lamp that is a point with this profile.
    Lamp(std::string name, const Point3& position, LampProfile profile,
         const Spectrum& axis_intensity);
    /// A sun.
    Lamp(std::string name, const Sunlight& sunlight, const Spectrum& irradiance);

    /// The same lamp as one of the scene's lamps, with this index.
    Lamp with_index(std::size_t index) const;
    /// The same emitter, but `factor` times as bright.
    Lamp brightened(double factor) const;
    /// Its mirror image (MirroredEmitter). Precondition: it has a position.
    Lamp mirrored(const WaterSurface& surface) const;
    /// The same emitter, which represents an emissive volume that light paths meet.
    Lamp met_by_paths() const;
    /// The same emitter in a scene with glass, which dims what it lights (GlassShadedEmitter).
    Lamp behind_glass(std::shared_ptr<const GlassOptics> glass) const;
    /// The same in as many emitters as there are bands, one for the light of each, behind glass
    /// that absorbs them differently.
    std::vector<Lamp> behind_coloured_glass(const std::shared_ptr<const GlassOptics>& glass,
                                            std::size_t bands) const;
    /// The same sun, focused by waves (FocusedEmitter): its light has the same irradiance on a
    /// level plane. Precondition: it is a sun.
    Lamp focused(std::shared_ptr<const SunFocus> focus) const;

    const std::string& name() const { return name_; }
    /// Which of the scene's lamps it belongs to.
    std::size_t index() const { return index_; }
    /// The fraction of that lamp's light that it represents.
    double fraction() const { return fraction_; }
    /// Radiant intensity on the axis per band [W/sr]; for an IES profile, in the brightest
    /// direction; for a sun, irradiance [W/m^2].
    const Spectrum& axis_intensity() const { return axis_intensity_; }

    const Emitter& emitter() const { return *emitter_; }
    /// Its position; undefined for a sun.
    Point3 position() const { return origin({}); }
    /// Whether it is one of several that represent parts of a luminous surface or of a sun's disc:
    /// its shadows are soft (origin_on_patch). A lamp that consists of one point casts hard ones.
    bool is_part() const { return fraction_ < 1 && emitter_->patch(); }

    /// Whether it represents an emissive volume only where it lights surfaces: the water's light is
    /// found by paths that meet the volume itself (EmissionSampler), as in all light.
    bool is_met_by_paths() const { return is_met_by_paths_; }

    /// @name The functions of its emitter, which has their descriptions
    /// @{
    std::string_view profile_name() const { return emitter_->profile_name(); }
    Point3 origin(const Point3& x) const { return emitter_->origin(x); }
    Point3 origin_on_patch(const Point3& x, const UnitPoint& place) const {
        return emitter_->origin_on_patch(x, place);
    }
    double patch_angle(double distance) const { return emitter_->patch_angle(distance); }
    double spread(double distance) const { return emitter_->spread(distance); }
    bool contains(double distance) const { return emitter_->contains(distance); }
    double relative_intensity(const Vector3& v) const { return emitter_->relative_intensity(v); }
    double focus(const Point3& x) const { return emitter_->focus(x); }
    void focus(const Ray& ray, std::span<const double> s, std::span<double> values) const {
        emitter_->focus(ray, s, values);
    }
    bool is_focused() const { return emitter_->is_focused(); }
    bool is_mirrored() const { return emitter_->is_mirrored(); }
    bool has_even_core() const { return emitter_->has_even_core(); }
    bool is_soft() const { return emitter_->is_soft(); }
    DirectionCone cone() const { return emitter_->cone(); }
    FineStructure fine_structure() const { return emitter_->fine_structure(); }
    Interval beam(const Ray& ray, const Interval& interval) const {
        return emitter_->beam(ray, interval);
    }
    void append_profile_breaks(const Ray& ray, const Interval& interval,
                               std::vector<double>& s) const {
        emitter_->append_profile_breaks(ray, interval, s);
    }
    LampPassage passage(const Ray& ray) const { return emitter_->passage(ray); }
    double squared_offset(const Ray& ray) const { return emitter_->squared_offset(ray); }
    const Sunlight* sunlight() const { return emitter_->sunlight(); }
    /// @}

    /// Compares all members, and emitters by what they are.
    friend bool operator==(const Lamp& a, const Lamp& b);

  private:
    std::string name_;
    std::shared_ptr<const Emitter> emitter_;
    Spectrum axis_intensity_;
    std::size_t index_;
    double fraction_;
    bool is_met_by_paths_ = false;
};

}  // namespace uw
