#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/optics/concentration_field.h"
#include "media/light/column_face.h"
#include "media/light/light_frame.h"

namespace uw {

/// Column concentrations in a sun's light: what a ColumnMap is for a lamp, with parallel rays over
/// a rectangle across the light that holds the field.
class SunColumnMap {
  public:
    /// As the constructor of ColumnMap: about `per_voxel` rays across the finest voxel and as many
    /// steps along it, fewer as the memory or the tolerance permits. `field` is not kept.
    SunColumnMap(const ConcentrationField& field, const Sunlight& sun, double per_voxel,
                 std::size_t memory_budget, const DepthTolerance& tolerance = {});

    /// As DeepShadow::columns: bilinear across the light, linear along it.
    void columns(std::span<const Point3> x, std::span<double> column) const;

    /// As DeepShadow::append_column_breaks: one break every two of the map's rays.
    void append_breaks(const Ray& ray, const Interval& interval, std::vector<double>& s) const;

    std::size_t bytes() const { return face_.bytes(); }
    std::uint64_t rays_traced() const { return face_.rays_traced(); }

  private:
    LightFrame frame_;
    double per_voxel_;
    std::size_t constituents_;
    double texel_ = 0;  // [m]
    LightPoint first_;  // the first texel's ray; its depth is that from which distances count
    int width_ = 0, height_ = 0;
    ColumnFace face_;
};

}  // namespace uw
