#pragma once

#include <span>

#include "core/base/affine.h"
#include "core/frame/pixel_view.h"
#include "core/integrators/integrator.h"
#include "core/integrators/slabs.h"

namespace uw {

/// Which parts of the in-scatter an image asks for.
struct InScatterParts {
    bool lamps = true;       // of each lamp by itself, not only the sum
    bool first_slab = true;  // of the first slab
};

/// The in-scatter along a ray up to a distance, as a list of values that can be interpolated: the
/// bands of each lamp's light (or of all lamps' together), then those of the first slab's, if it is
/// asked for [W m^-2 sr^-1].
class RayInScatter {
  public:
    /// `integrator` outlives this; the first slab is that of `slabs`.
    RayInScatter(const Integrator& integrator, const Affine& world_from_camera, const Slabs& slabs,
                 int lamps, int bands, const InScatterParts& parts);

    /// Values in a list.
    std::size_t value_count() const { return (groups_ + (parts_.first_slab ? 1 : 0)) * bands_; }
    std::size_t band_count() const { return bands_; }
    const InScatterParts& parts() const { return parts_; }
    /// Groups of lamps: each by itself, or all in one.
    std::size_t group_count() const { return groups_; }
    /// The bands of one group's light in a list.
    std::span<const double> group(std::span<const double> values, std::size_t group) const {
        return values.subspan(group * bands_, bands_);
    }
    /// The bands of the first slab's light in a list. Precondition: parts().first_slab.
    std::span<const double> first_slab(std::span<const double> values) const {
        return values.subspan(groups_ * bands_, bands_);
    }

    /// Integrates up to each of `distances` [m, > 0] and writes a list for each, one after another.
    /// Thread safe.
    void integrate(const Ray& ray, std::span<const double> distances,
                   std::span<double> values) const;

    /// Writes the list of a pixel: the weighted mean over its distances, zeros without a ray.
    /// Thread safe.
    void integrate(const PixelView& view, std::span<double> values) const;

  private:
    Interval first_slab_along(const Ray& ray) const;

    const Integrator& integrator_;
    Affine camera_from_world_;
    Slabs slabs_;
    std::size_t lamps_, bands_, groups_;
    InScatterParts parts_;
};

}  // namespace uw
