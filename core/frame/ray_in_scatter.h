#pragma once

#include <span>

#include "core/base/affine.h"
#include "core/frame/pixel_view.h"
#include "core/integrators/integrator.h"
#include "core/integrators/slabs.h"

namespace uw {

/// The parts of the in-scatter that an image requires.
struct InScatterParts {
    bool lamps = true;       // each lamp separately, not only the sum
    bool first_slab = true;  // of the first slab
};

/// The in-scatter along a ray up to a distance, as a list of values that can be interpolated: the
/// bands for each lamp (or for all lamps together), then those for the first slab, if requested [W
/// m^-2 sr^-1].
class RayInScatter {
  public:
    /// `integrator` must outlive this object; the first slab is that of `slabs`.
    RayInScatter(const Integrator& integrator, const Affine& world_from_camera, const Slabs& slabs,
                 int lamps, int bands, const InScatterParts& parts);

    /// Number of values in a list.
    std::size_t value_count() const { return (groups_ + (parts_.first_slab ? 1 : 0)) * bands_; }
    std::size_t band_count() const { return bands_; }
    const InScatterParts& parts() const { return parts_; }
    /// Number of lamp groups: one per lamp, or one for all lamps.
    std::size_t group_count() const { return groups_; }
    /// The bands of one group's light in a list.
    std::span<const double> group(std::span<const double> values, std::size_t group) const {
        return values.subspan(group * bands_, bands_);
    }
    /// The bands of the first slab's light in a list. Precondition: parts().first_slab.
    std::span<const double> first_slab(std::span<const double> values) const {
        return values.subspan(groups_ * bands_, bands_);
    }

    /// Integrates up to each of `distances` [m, > 0] and writes the lists consecutively. Thread
    /// safe.
    void integrate(const Ray& ray, std::span<const double> distances,
                   std::span<double> values) const;

    /// Writes the list of a pixel: the weighted mean over its distances, zeros without a ray.
    /// Thread safe.
    void integrate(const PixelView& view, std::span<double> values) const;

    /// The part of the ray within the first slab [m]; empty if it does not pass it.
    Interval first_slab_along(const Ray& ray) const;

  private:
    const Integrator& integrator_;
    Affine camera_from_world_;
    Slabs slabs_;
    std::size_t lamps_, bands_, groups_;
    InScatterParts parts_;
};

}  // namespace uw
