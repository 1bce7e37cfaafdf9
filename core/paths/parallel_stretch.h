#pragma once

#include "core/base/ray.h"
#include "core/integrators/ray_panels.h"

namespace uw {

/// Where on a line the parallel light of a sun is scattered along it: distances drawn as its way
/// through uniform water attenuates it.
class ParallelStretch {
  public:
    ParallelStretch() = default;
    /// `lit`: what the sun illuminates of the line; may be infinite only if the light falls along
    /// it. `attenuation`: of the water [1/m].
    ParallelStretch(const LampPassage& passage, const Interval& lit, double attenuation)
        : lit_(lit), rate_(attenuation * (1 + passage.slope)) {}

    /// The length over which light as bright as at the beginning would be scattered as much [m].
    double effective_length() const;
    /// The distance up to which a `share` (0..1) of all lie.
    double draw(double share) const;
    /// The density of what is drawn at `s` [1/m].
    double density(double s) const;

  private:
    Interval lit_;
    double rate_ = 0;  // of e^(-rate s) [1/m]
};

}  // namespace uw
