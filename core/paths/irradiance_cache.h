#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "core/base/ray.h"
#include "core/geometry/surfaces.h"

namespace uw {

/// A point on a surface of which the indirect light is known.
struct IrradianceRecord {
    Point3 position;
    Vector3 normal{0, 0, 1};  // shading normal, unit
};

/// The indirect light on surfaces, that which was scattered or reflected before it arrives: known
/// at points that lie scattered over them, and interpolated in between (Ward, Rubinstein and Clear
/// 1988, but with points that are given). Thread safe.
class IrradianceCache {
  public:
    /// `radiance`: what a white surface would reflect of it, [point * values + value]
    /// [W m^-2 sr^-1].
    IrradianceCache(std::vector<IrradianceRecord> points, std::vector<float> radiance,
                    std::size_t values);
    ~IrradianceCache();
    IrradianceCache(const IrradianceCache&) = delete;
    IrradianceCache& operator=(const IrradianceCache&) = delete;
    IrradianceCache(IrradianceCache&&) noexcept;
    IrradianceCache& operator=(IrradianceCache&&) noexcept;

    /// How many values each point has.
    std::size_t values() const { return values_; }
    /// Sets `radiance` to the values at a surface, or to 0 where no point is known. Adds nothing
    /// from points on the other side of a thin wall.
    void find(const SurfaceHit& hit, std::span<double> radiance) const;
    /// Whether a point that faces the same way lies within `radius` [m] of the hit.
    bool covers(const SurfaceHit& hit, double radius) const;

  private:
    class Tree;
    struct Near;

    // What each of the points counts; false if none of them tells of the hit.
    bool find_shares(const SurfaceHit& hit, const Near& near, std::span<double> shares) const;

    std::unique_ptr<const Tree> tree_;
    std::vector<float> radiance_;
    std::size_t values_;
};

}  // namespace uw
