#pragma once

#include <span>

#include "core/base/affine.h"
#include "core/frame/pixel_view.h"
#include "core/integrators/integrator.h"
#include "core/integrators/slabs.h"

namespace uw {

/// Which parts of the in-scatter an image asks for.
struct InScatterParts {
    bool lamps = true;       // of each lamp apart, not only the sum
    bool first_slab = true;  // of the first slab
};

/// The in-scatter along a ray up to a distance as a row of numbers, so that rows can be mixed: per
/// lamp (or for all of them together) its bands, then those of the first slab if asked for
/// [W m^-2 sr^-1].
class RayInScatter {
  public:
    /// `integrator` outlives this; the first slab is that of `slabs`.
    RayInScatter(const Integrator& integrator, const Affine& world_from_camera, const Slabs& slabs,
                 int lamps, int bands, const InScatterParts& parts);

    std::size_t row_size() const { return (groups_ + (parts_.first_slab ? 1 : 0)) * bands_; }
    std::size_t band_count() const { return bands_; }
    const InScatterParts& parts() const { return parts_; }
    /// In-scatter by group `group` of a row; groups: the lamps, or one of all.
    std::size_t group_count() const { return groups_; }
    std::span<const double> group(std::span<const double> row, std::size_t group) const {
        return row.subspan(group * bands_, bands_);
    }
    /// The first slab's part of a row. Precondition: parts().first_slab.
    std::span<const double> first_slab(std::span<const double> row) const {
        return row.subspan(groups_ * bands_, bands_);
    }

    /// Writes a row for each of `distances` [m, > 0]. Thread safe.
    void gather(const Ray& ray, std::span<const double> distances, std::span<double> rows) const;

    /// Writes the row of a pixel: the mean over its ends, zeros without a ray. Thread safe.
    void gather(const PixelView& view, std::span<double> row) const;

  private:
    Interval first_slab_along(const Ray& ray) const;

    const Integrator& integrator_;
    Affine camera_from_world_;
    Slabs slabs_;
    std::size_t lamps_, bands_, groups_;
    InScatterParts parts_;
};

}  // namespace uw
