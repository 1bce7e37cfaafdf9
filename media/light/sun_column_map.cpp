#include "media/light/sun_column_map.h"

#include <algorithm>
#include <cmath>

#include "media/light/bounds_corners.h"

namespace uw {

namespace {

constexpr int k_most_texels = 1 << 14;  // along an edge

}  // namespace

SunColumnMap::SunColumnMap(const ConcentrationField& field, const Sunlight& sun, double per_voxel,
                           std::size_t memory_budget, const DepthTolerance& tolerance)
    : frame_(sun),
      per_voxel_(per_voxel),
      constituents_(static_cast<std::size_t>(field.constituent_count())) {
    const Bounds bounds = field.bounds();
    if (bounds.empty() || constituents_ == 0) return;
    LightPoint least{k_infinity, k_infinity, k_infinity};
    LightPoint most{-k_infinity, -k_infinity, -k_infinity};
    for (const Point3& corner : corners(bounds)) {
        const LightPoint p = frame_.point(corner);
        least = {std::min(least.u, p.u), std::min(least.v, p.v), std::min(least.depth, p.depth)};
        most = {std::max(most.u, p.u), std::max(most.v, p.v), std::max(most.depth, p.depth)};
    }
    const double fine = field.finest_voxel() / per_voxel;
    const double rays = (most.u - least.u) * (most.v - least.v) / (fine * fine);
    const Vector3 size = bounds.max - bounds.min;
    const double samples = size.x * size.y * size.z / (fine * fine * fine);
    const auto budget = static_cast<double>(memory_budget);
    const double coarsening = std::max(
        {1.0, std::cbrt(samples * static_cast<double>(constituents_ * sizeof(float)) / budget),
         std::sqrt(rays * ColumnFace::k_bytes_per_texel / budget),
         std::max(most.u - least.u, most.v - least.v) / (fine * k_most_texels)});
    texel_ = coarsening * fine;
    // With a border of one texel for interpolation.
    first_ = {least.u - texel_, least.v - texel_, least.depth};
    width_ = static_cast<int>(std::ceil((most.u - least.u) / texel_)) + 3;
    height_ = static_cast<int>(std::ceil((most.v - least.v) / texel_)) + 3;
    const auto march = [&](int x, int y, ConcentrationProfile& profile) {
        const double u = first_.u + x * texel_, v = first_.v + y * texel_;
        // A field that reaches out of the water counts below the surface only.
        const double begin = std::clamp(frame_.entry_depth(u, v), first_.depth, most.depth);
        field.profile_within(tolerance, {frame_.world({u, v, begin}), sun.direction},
                             most.depth - begin + texel_, profile);
        for (double& s : profile.s) s += begin - first_.depth;
    };
    // A sun's light is as bright everywhere: an error counts the same at all distances.
    face_ = ColumnFace(width_, height_, field.constituent_count(), texel_, 0, tolerance, march);
}

void SunColumnMap::columns(std::span<const Point3> x, std::span<double> column) const {
    std::fill(column.begin(), column.end(), 0.0);
    if (face_.empty()) return;
    for (std::size_t i = 0; i < x.size(); ++i) {
        const LightPoint p = frame_.point(x[i]);
        face_.add((p.u - first_.u) / texel_, (p.v - first_.v) / texel_, p.depth - first_.depth,
                  column.subspan(i * constituents_, constituents_));
    }
}

void SunColumnMap::append_breaks(const Ray& ray, const Interval& interval,
                                 std::vector<double>& s) const {
    if (face_.empty()) return;
    const LightPoint begin = frame_.point(ray.origin), rates = frame_.rates(ray.direction);
    const double half_u = 0.5 * (width_ - 1) * texel_, half_v = 0.5 * (height_ - 1) * texel_;
    const Interval part =
        inside(begin, rates, interval, {first_.u + half_u, first_.v + half_v, 0}, half_u, half_v);
    if (!(part.length() > 0)) return;
    s.push_back(part.begin);
    const double texels_per_metre = std::max(std::abs(rates.u), std::abs(rates.v)) / texel_;
    for (double at = part.begin; at < part.end;) {
        const int spacing = face_.spacing((begin.u + at * rates.u - first_.u) / texel_,
                                          (begin.v + at * rates.v - first_.v) / texel_);
        at += std::max(1.0, per_voxel_) * std::max(1, spacing) / texels_per_metre;
        if (spacing > 0 && at < part.end) s.push_back(at);
    }
}

}  // namespace uw
