#pragma once

#include <span>

#include "core/paths/scattering_tables.h"
#include "core/paths/water_segment.h"

namespace uw {

/// How much light of the lamps the water around a point may hold: guides random paths, and nothing
/// but their variance depends on it. Thread safe.
class LampGlow {
  public:
    /// Both must outlive this object.
    LampGlow(const WaterOptics& optics, const ScatteringTables& tables)
        : optics_(optics), tables_(tables) {}

    /// I e^(-c R) / R of a lamp, with c of the uniform water, summed over the bands with these
    /// weights [W sr^-1 m^-1].
    double of_lamp(std::size_t lamp, const Point3& x, const Spectrum& weights) const;
    /// The same of all lamps in each band, times ScatteringTables::spread_glow of the angle to
    /// each: b times this is roughly the radiance that is scattered once and, at `x`, once more
    /// back along `direction`, per metre and b.
    void spread(const Point3& x, const Vector3& direction, std::span<double> values) const;

  private:
    const WaterOptics& optics_;
    const ScatteringTables& tables_;
};

}  // namespace uw
