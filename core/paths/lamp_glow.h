#pragma once

#include "core/integrators/ray_panels.h"
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
    /// weights [W sr^-1 m^-1]; of a sun, E e^(-c R) over the least c.
    double of_lamp(std::size_t lamp, const Point3& x, const Spectrum& weights) const;
    /// Along the ray with this `passage` of a lamp, at the point `x` at `s`: I / R times
    /// ScatteringTables::spread_glow, relative to the lamp's intensity, and R. With e^(-c R) and b,
    /// it is roughly the radiance that is scattered once and, at `x`, once more back along the
    /// ray, per metre and b.
    struct Spread {
        double relative = 0, radius = 0;
    };
    Spread spread(std::size_t lamp, const LampPassage& passage, double s, const Point3& x) const;

  private:
    double clearest() const;

    const WaterOptics& optics_;
    const ScatteringTables& tables_;
};

}  // namespace uw
