#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "core/base/ray.h"
#include "core/geometry/surfaces.h"

namespace uw {

/// A point on a surface at which indirect irradiance is cached.
struct IrradianceRecord {
    Point3 position;
    Vector3 normal{0, 0, 1};  // shading normal, unit
};

/// A cache of indirect light on surfaces, i.e. light that was scattered or reflected before it
/// arrives, interpolated between scattered records (Ward et al. 1988, but the records are given and
/// not made on demand). Thread safe.
class IrradianceCache {
  public:
    /// `radiance`: the indirect irradiance / pi, as a white surface would reflect it, [record *
    /// values + value] [W m^-2 sr^-1].
    IrradianceCache(std::vector<IrradianceRecord> records, std::vector<float> radiance,
                    std::size_t values);
    ~IrradianceCache();
    IrradianceCache(const IrradianceCache&) = delete;
    IrradianceCache& operator=(const IrradianceCache&) = delete;
    IrradianceCache(IrradianceCache&&) noexcept;
    IrradianceCache& operator=(IrradianceCache&&) noexcept;

    /// The number of values of each record.
    std::size_t values() const { return values_; }
    /// Interpolates at a surface; 0 where no record applies. Records on the other side of a thin
    /// wall contribute nothing.
    void find(const SurfaceHit& hit, std::span<double> radiance) const;
    /// Whether a record that faces the same way lies within `radius` [m] of the hit.
    bool covers(const SurfaceHit& hit, double radius) const;

  private:
    class Tree;
    struct Near;

    // The coefficients of the records in the interpolated value, which add up to 1; false if no
    // record applies to the hit.
    bool find_coefficients(const SurfaceHit& hit, const Near& near,
                           std::span<double> coefficients) const;

    std::unique_ptr<const Tree> tree_;
    std::vector<float> radiance_;
    std::size_t values_;
};

}  // namespace uw
