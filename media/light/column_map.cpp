#include "media/light/column_map.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"

namespace uw {

namespace {

constexpr int k_max_resolution = 1 << 16;
constexpr int k_min_resolution = 16;

std::array<Point3, 8> corners(const Bounds& b) {
    std::array<Point3, 8> result;
    for (std::size_t i = 0; i < 8; ++i)
        result[i] = {(i & 1) != 0 ? b.max.x : b.min.x, (i & 2) != 0 ? b.max.y : b.min.y,
                     (i & 4) != 0 ? b.max.z : b.min.z};
    return result;
}

double farthest_corner(const Bounds& bounds, const Point3& from) {
    double farthest = 0;
    for (const Point3& corner : corners(bounds))
        farthest = std::max(farthest, distance(corner, from));
    return farthest;
}

// Clips `part` of the straight line from `a` to `b` to where it lies within [-1, size].
void clip(double a, double b, int size, Interval& part) {
    if (a == b) {
        if (a < -1 || a > size) part = {1, 0};
        return;
    }
    const double to_low = (-1 - a) / (b - a), to_high = (size - a) / (b - a);
    part.begin = std::max(part.begin, std::min(to_low, to_high));
    part.end = std::min(part.end, std::max(to_low, to_high));
}

}  // namespace

ColumnMap::ColumnMap(const ConcentrationField& field, const Point3& lamp, double per_voxel,
                     std::size_t memory_budget)
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
    const double coarsening = std::max(
        {1.0, std::cbrt(sample_bytes / budget), std::sqrt(rays * sizeof(TexelRay) / budget)});
    resolution_ = static_cast<int>(
        std::clamp(texels / coarsening, double(k_min_resolution), double(k_max_resolution)));
    step_ = coarsening / steps;
    for (int face = 0; face < 6; ++face) {
        const FaceRectangle& rectangle = rectangles[static_cast<std::size_t>(face)];
        if (!rectangle.empty()) trace_face(field, face, rectangle, farthest_corner(bounds, lamp));
    }
}

// Chooses the texels to store: those of the rectangle, and a border of one for interpolation.
void ColumnMap::crop(const FaceRectangle& rectangle, Face& out) const {
    const auto first = [&](double u) {
        return std::max(-1, static_cast<int>(std::floor(texel_u(u))) - 1);
    };
    const auto last = [&](double u) {
        return std::min(resolution_, static_cast<int>(std::floor(texel_u(u))) + 2);
    };
    out.u0 = first(rectangle.u_min);
    out.v0 = first(rectangle.v_min);
    out.rays.assign(last(rectangle.u_max) - out.u0 + 1, last(rectangle.v_max) - out.v0 + 1);
}

void ColumnMap::trace_face(const ConcentrationField& field, int face_index,
                           const FaceRectangle& rectangle, double reach) {
    Face& out = faces_[static_cast<std::size_t>(face_index)];
    crop(rectangle, out);
    const CubeFace face(face_index);
    out.rows.resize(static_cast<std::size_t>(out.rays.height()));
    parallel_for(out.rows.size(), [&](std::size_t row) {
        thread_local ConcentrationProfile profile;
        const int y = static_cast<int>(row);
        for (int x = 0; x < out.rays.width(); ++x) {
            const double u = (2.0 * (out.u0 + x) + 1.0) / resolution_ - 1.0;
            const double v = (2.0 * (out.v0 + y) + 1.0) / resolution_ - 1.0;
            field.profile({lamp_, glm::normalize(face.direction(u, v))}, reach, profile);
            append_samples(profile, step_, out.rows[row], out.rays(x, y));
        }
        out.rows[row].shrink_to_fit();
    });
}

// Resamples a profile's columns at equal steps from where they start to where they end.
void ColumnMap::append_samples(const ConcentrationProfile& profile, double step,
                               std::vector<float>& samples, TexelRay& ray) {
    const auto constituents = static_cast<std::size_t>(profile.constituent_count);
    std::size_t first = 0;
    while (first + 1 < profile.s.size() && profile.empty_between(first)) ++first;
    std::size_t last = profile.s.size() - 1;
    while (last > first && profile.empty_between(last - 1)) --last;
    ray = {};
    if (first == last) return;
    const double begin = profile.s[first];
    ray.begin = static_cast<float>(begin);
    ray.count = static_cast<std::uint32_t>(std::ceil((profile.s[last] - begin) / step)) + 1;
    ray.offset = static_cast<std::uint32_t>(samples.size());
    std::size_t knot = first;
    for (std::uint32_t i = 0; i < ray.count; ++i) {
        const double s = std::min(begin + i * step, profile.s[last]);
        while (knot + 1 < last && profile.s[knot + 1] < s) ++knot;
        const double length = profile.s[knot + 1] - profile.s[knot];
        const double t = (s - profile.s[knot]) / length;
        for (std::size_t k = 0; k < constituents; ++k) {
            const std::size_t at = knot * constituents + k;
            const double nu = profile.concentration[at];
            const double slope = profile.concentration[at + constituents] - nu;
            samples.push_back(
                static_cast<float>(profile.column[at] + t * length * (nu + 0.5 * t * slope)));
        }
    }
}

void ColumnMap::add_texel(const Face& face, int u, int v, double distance, double weight,
                          std::span<double> column) const {
    if (u < 0 || v < 0 || u >= face.rays.width() || v >= face.rays.height()) return;
    const TexelRay& ray = face.rays(u, v);
    const double at = (distance - static_cast<double>(ray.begin)) / step_;
    if (ray.count == 0 || at <= 0) return;
    const auto last = static_cast<double>(ray.count - 1);
    const double clamped = std::min(at, last);
    const auto i = static_cast<std::size_t>(std::min(clamped, std::max(0.0, last - 1)));
    const double t = clamped - static_cast<double>(i);
    const float* sample =
        face.rows[static_cast<std::size_t>(v)].data() + ray.offset + i * constituents_;
    const float* next = ray.count > 1 ? sample + constituents_ : sample;
    for (std::size_t k = 0; k < constituents_; ++k)
        column[k] +=
            weight * ((1 - t) * static_cast<double>(sample[k]) + t * static_cast<double>(next[k]));
}

void ColumnMap::columns(std::span<const Point3> x, std::span<double> column) const {
    std::fill(column.begin(), column.end(), 0.0);
    if (resolution_ == 0) return;
    for (std::size_t i = 0; i < x.size(); ++i) {
        const Vector3 v = x[i] - lamp_;
        const int index = cube_face_of(v);
        const Face& face = faces_[static_cast<std::size_t>(index)];
        if (face.rays.empty()) continue;
        const CubeFace projection(index);
        const double u = texel_u(projection.u(v)) - face.u0;
        const double w = texel_u(projection.v(v)) - face.v0;
        if (!(u > -1 && w > -1 && u < face.rays.width() && w < face.rays.height())) continue;
        const double distance = glm::length(v);
        const int iu = static_cast<int>(std::floor(u)), iw = static_cast<int>(std::floor(w));
        const double fu = u - iu, fw = w - iw;
        const std::span<double> out = column.subspan(i * constituents_, constituents_);
        add_texel(face, iu, iw, distance, (1 - fu) * (1 - fw), out);
        add_texel(face, iu + 1, iw, distance, fu * (1 - fw), out);
        add_texel(face, iu, iw + 1, distance, (1 - fu) * fw, out);
        add_texel(face, iu + 1, iw + 1, distance, fu * fw, out);
    }
}

bool ColumnMap::any_particles(const Face& face, double u, double v) const {
    const int u0 = static_cast<int>(std::floor(u)), v0 = static_cast<int>(std::floor(v));
    for (int j = v0; j <= v0 + 1; ++j) {
        for (int i = u0; i <= u0 + 1; ++i) {
            if (i >= 0 && j >= 0 && i < face.rays.width() && j < face.rays.height() &&
                face.rays(i, j).count > 0)
                return true;
        }
    }
    return false;
}

void ColumnMap::append_breaks(const Ray& ray, const Interval& interval,
                              std::vector<double>& s) const {
    if (resolution_ == 0) return;
    thread_local std::vector<FaceSegment> segments;
    split_by_face(ray, lamp_, interval, segments);
    for (const FaceSegment& segment : segments) {
        const Face& face = faces_[static_cast<std::size_t>(segment.face)];
        if (face.rays.empty()) continue;
        const CubeFace projection(segment.face);
        const Vector3 a = ray.at(segment.stretch.begin) - lamp_;
        const Vector3 b = ray.at(segment.stretch.end) - lamp_;
        const double depth_a = projection.depth(a), depth_b = projection.depth(b);
        if (!(depth_a > 0 && depth_b > 0)) continue;
        const double ua = texel_u(projection.u(a)) - face.u0,
                     ub = texel_u(projection.u(b)) - face.u0;
        const double va = texel_u(projection.v(a)) - face.v0,
                     vb = texel_u(projection.v(b)) - face.v0;
        const int steps = static_cast<int>(
            std::ceil(std::max(std::abs(ub - ua), std::abs(vb - va)) / std::max(1.0, per_voxel_)));
        s.push_back(segment.stretch.begin);
        Interval stored{0, 1};  // the part of the line on texels that are stored
        clip(ua, ub, face.rays.width(), stored);
        clip(va, vb, face.rays.height(), stored);
        if (stored.length() < 0) continue;
        const int last = std::min(steps - 1, static_cast<int>(stored.end * steps));
        for (int i = std::max(1, static_cast<int>(stored.begin * steps)); i <= last; ++i) {
            const double t = static_cast<double>(i) / steps;
            if (!any_particles(face, ua + t * (ub - ua), va + t * (vb - va))) continue;
            // Equal steps on the face are not equal steps in space: interpolate s / depth.
            s.push_back(
                (segment.stretch.begin * depth_b * (1 - t) + segment.stretch.end * depth_a * t) /
                (depth_b * (1 - t) + depth_a * t));
        }
    }
}

std::size_t ColumnMap::bytes() const {
    std::size_t total = 0;
    for (const Face& face : faces_) {
        total += face.rays.size() * sizeof(TexelRay);
        for (const std::vector<float>& row : face.rows) total += row.size() * sizeof(float);
    }
    return total;
}

std::uint64_t ColumnMap::rays_traced() const {
    std::uint64_t total = 0;
    for (const Face& face : faces_) total += face.rays.size();
    return total;
}

}  // namespace uw
