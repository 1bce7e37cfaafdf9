#include "media/light/column_map.h"

#include <algorithm>
#include <cmath>

#include "media/light/bounds_corners.h"

namespace uw {

namespace {

constexpr int k_max_resolution = 1 << 16;
constexpr int k_min_resolution = 16;

double farthest_corner(const Bounds& bounds, const Point3& from) {
    double farthest = 0;
    for (const Point3& corner : corners(bounds))
        farthest = std::max(farthest, distance(corner, from));
    return farthest;
}

}  // namespace

ColumnMap::ColumnMap(const ConcentrationField& field, const Point3& lamp, double per_voxel,
                     std::size_t memory_budget, const DepthTolerance& tolerance)
    : lamp_(lamp),
      per_voxel_(per_voxel),
      constituents_(static_cast<std::size_t>(field.constituent_count())) {
    const Bounds bounds = field.bounds();
    if (bounds.empty() || constituents_ == 0) return;
    const double voxel = field.finest_voxel();
    // A lamp inside a volume may be close to its centre; the distant parts still need voxel-wide
    // texels.
    const double typical = std::max(distance(bounds.center(), lamp), 0.25 * bounds.diagonal());
    const double texels = per_voxel_ * 2 * typical / voxel;  // along a face, which is 2 wide
    const double steps = per_voxel_ / voxel;                 // per metre

    std::array<FaceRectangle, 6> rectangles;
    double rays = 0, samples = 0;  // required at this resolution
    for (int face = 0; face < 6; ++face) {
        FaceRectangle& rectangle = rectangles[static_cast<std::size_t>(face)];
        rectangle = project_box(bounds, lamp, CubeFace(face));
        if (rectangle.empty()) continue;
        rays += 0.25 * texels * texels * (rectangle.u_max - rectangle.u_min) *
                (rectangle.v_max - rectangle.v_min);
        samples += 0.25 * texels * texels * steps *
                   integrate_chords(bounds, lamp, CubeFace(face), rectangle);
    }
    const auto budget = static_cast<double>(memory_budget);
    const double sample_bytes = samples * static_cast<double>(constituents_ * sizeof(float));
    const double coarsening = std::max({1.0, std::cbrt(sample_bytes / budget),
                                        std::sqrt(rays * ColumnFace::k_bytes_per_texel / budget)});
    resolution_ = static_cast<int>(
        std::clamp(texels / coarsening, double(k_min_resolution), double(k_max_resolution)));
    step_ = coarsening / steps;
    for (int face = 0; face < 6; ++face) {
        const FaceRectangle& rectangle = rectangles[static_cast<std::size_t>(face)];
        if (!rectangle.empty())
            trace_face(field, face, rectangle, farthest_corner(bounds, lamp), typical, tolerance);
    }
}

// Stores the texels of the rectangle, and a border of one for interpolation.
void ColumnMap::trace_face(const ConcentrationField& field, int face_index,
                           const FaceRectangle& rectangle, double reach, double reference,
                           const DepthTolerance& tolerance) {
    const auto first = [&](double u) {
        return std::max(-1, static_cast<int>(std::floor(texel_u(u))) - 1);
    };
    const auto last = [&](double u) {
        return std::min(resolution_, static_cast<int>(std::floor(texel_u(u))) + 2);
    };
    Face& out = faces_[static_cast<std::size_t>(face_index)];
    out.u0 = first(rectangle.u_min);
    out.v0 = first(rectangle.v_min);
    const CubeFace face(face_index);
    const auto march = [&](int x, int y, ConcentrationProfile& profile) {
        const double u = (2.0 * (out.u0 + x) + 1.0) / resolution_ - 1.0;
        const double v = (2.0 * (out.v0 + y) + 1.0) / resolution_ - 1.0;
        field.profile_within(tolerance, {lamp_, glm::normalize(face.direction(u, v))}, reach,
                             profile);
    };
    out.columns = ColumnFace(last(rectangle.u_max) - out.u0 + 1, last(rectangle.v_max) - out.v0 + 1,
                             field.constituent_count(), step_, reference, tolerance, march);
}

void ColumnMap::columns(std::span<const Point3> x, std::span<double> column) const {
    std::fill(column.begin(), column.end(), 0.0);
    if (resolution_ == 0) return;
    for (std::size_t i = 0; i < x.size(); ++i) {
        const Vector3 v = x[i] - lamp_;
        const int index = cube_face_of(v);
        const Face& face = faces_[static_cast<std::size_t>(index)];
        if (face.columns.empty()) continue;
        const CubeFace projection(index);
        face.columns.add(texel_u(projection.u(v)) - face.u0, texel_u(projection.v(v)) - face.v0,
                         glm::length(v), column.subspan(i * constituents_, constituents_));
    }
}

void ColumnMap::append_breaks(const Ray& ray, const Interval& interval,
                              std::vector<double>& s) const {
    if (resolution_ == 0) return;
    thread_local std::vector<FaceSegment> segments;
    split_by_face(ray, lamp_, interval, segments);
    for (const FaceSegment& segment : segments) {
        const Face& face = faces_[static_cast<std::size_t>(segment.face)];
        if (face.columns.empty()) continue;
        const CubeFace projection(segment.face);
        const Vector3 a = ray.at(segment.stretch.begin) - lamp_;
        const Vector3 b = ray.at(segment.stretch.end) - lamp_;
        const double depth_a = projection.depth(a), depth_b = projection.depth(b);
        if (!(depth_a > 0 && depth_b > 0)) continue;
        const double ua = texel_u(projection.u(a)) - face.u0,
                     ub = texel_u(projection.u(b)) - face.u0;
        const double va = texel_u(projection.v(a)) - face.v0,
                     vb = texel_u(projection.v(b)) - face.v0;
        const double texels = std::max(std::abs(ub - ua), std::abs(vb - va));
        s.push_back(segment.stretch.begin);
        for (double t = 0; t < 1;) {
            const int spacing = face.columns.spacing(ua + t * (ub - ua), va + t * (vb - va));
            t += std::max(1.0, per_voxel_) * std::max(1, spacing) / texels;
            // Equal steps on the face are not equal steps in space: interpolate s / depth.
            if (spacing > 0 && t < 1)
                s.push_back((segment.stretch.begin * depth_b * (1 - t) +
                             segment.stretch.end * depth_a * t) /
                            (depth_b * (1 - t) + depth_a * t));
        }
    }
}

std::size_t ColumnMap::bytes() const {
    std::size_t total = 0;
    for (const Face& face : faces_) total += face.columns.bytes();
    return total;
}

std::uint64_t ColumnMap::rays_traced() const {
    std::uint64_t total = 0;
    for (const Face& face : faces_) total += face.columns.rays_traced();
    return total;
}

}  // namespace uw
