#include "media/light/column_map.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "media/light/light_projection.h"

namespace uw {

namespace {

// Rays are at most this many texels apart, which is two voxels, so that the rays halfway miss
// nothing.
constexpr int k_widest = 4;
// Samples along a ray are at most this many of the least steps apart.
constexpr int k_longest_steps = 16;
// An error along a ray counts this many times as much as one across rays: the curvature of columns
// has the same sign throughout a cloud, so that the errors of neighbouring rays do not cancel along
// a camera ray.
constexpr double k_along = 5;

// The first and last knot of the interval of a profile that contains particles.
struct Filled {
    std::size_t first, last;
};

Filled filled(const ConcentrationProfile& profile) {
    std::size_t first = 0;
    while (first + 1 < profile.s.size() && profile.empty_between(first)) ++first;
    std::size_t last = profile.s.size() - 1;
    while (last > first && profile.empty_between(last - 1)) --last;
    return {first, last};
}

// Appends the profile's columns at `count` equal steps over `part`, and at its beginning.
void resample(const ConcentrationProfile& profile, const Filled& part, std::size_t count,
              std::vector<float>& samples) {
    const auto constituents = static_cast<std::size_t>(profile.constituent_count);
    const double begin = profile.s[part.first], end = profile.s[part.last];
    std::size_t knot = part.first;
    for (std::size_t i = 0; i <= count; ++i) {
        const double fraction = static_cast<double>(i) / static_cast<double>(count);
        const double s = begin + fraction * (end - begin);
        while (knot + 1 < part.last && profile.s[knot + 1] < s) ++knot;
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

// The weight of an error at a distance from the lamp, whose light falls with the square.
double weight_at(double distance, double reference) {
    const double ratio = reference / distance;
    return ratio > 1 ? ratio * ratio : 1;
}

// Whether linear interpolation between the resampled columns agrees with the profile's.
bool follows(const ConcentrationProfile& profile, const Filled& part, std::size_t count,
             const float* samples, double reference, const DepthTolerance& tolerance) {
    const auto constituents = static_cast<std::size_t>(profile.constituent_count);
    std::vector<double> error(constituents);
    const double begin = profile.s[part.first];
    const double per_metre = static_cast<double>(count) / (profile.s[part.last] - begin);
    for (std::size_t knot = part.first + 1; knot < part.last; ++knot) {
        const double at = (profile.s[knot] - begin) * per_metre;
        const std::size_t i = std::min(static_cast<std::size_t>(at), count - 1);
        const double t = at - static_cast<double>(i);
        const double weight = k_along * weight_at(profile.s[knot], reference);
        for (std::size_t k = 0; k < constituents; ++k) {
            const auto low = static_cast<double>(samples[i * constituents + k]);
            const auto high = static_cast<double>(samples[(i + 1) * constituents + k]);
            error[k] = weight * (low + t * (high - low) - profile.column[knot * constituents + k]);
        }
        const std::span before =
            std::span(profile.column).subspan(knot * constituents, constituents);
        if (!tolerance.allows(error, 0, before)) return false;
    }
    return true;
}

}  // namespace

ColumnFace::ColumnFace(int width, int height, int constituents, double step, double reference,
                       const DepthTolerance& tolerance, const March& march)
    : width_(width),
      height_(height),
      constituents_(static_cast<std::size_t>(constituents)),
      reference_(reference),
      step_(step) {
    const int across = (width + k_square - 2) / k_square, down = (height + k_square - 2) / k_square;
    spacing_.assign(std::max(1, across), std::max(1, down));
    rays_.assign(spacing_.width() * k_square + 1, spacing_.height() * k_square + 1);
    rows_.resize(static_cast<std::size_t>(rays_.height()));
    if (tolerance.exact()) {
        trace(1, tolerance, march);
        std::fill(spacing_.begin(), spacing_.end(), std::uint8_t{1});
        return;
    }
    trace(k_widest, tolerance, march);
    for (int apart = k_widest / 2; apart >= 1; apart /= 2) {
        trace(apart, tolerance, march);
        parallel_for(spacing_.size(), [&](std::size_t square) {
            if (spacing_[square] != 0) return;
            const auto u = static_cast<int>(square) % spacing_.width();
            const auto v = static_cast<int>(square) / spacing_.width();
            if (apart == 1 || confirmed(u, v, apart, tolerance))
                spacing_[square] = static_cast<std::uint8_t>(apart);
        });
    }
    for (std::vector<float>& row : rows_) row.shrink_to_fit();
}

// Traces the missing ones of the rays `apart` texels apart in the squares that need them, square by
// square, as neighbouring rays read the same voxels.
void ColumnFace::trace(int apart, const DepthTolerance& tolerance, const March& march) {
    const auto bands = static_cast<std::size_t>((rays_.height() - 1) / k_square + 1);
    parallel_for(bands, [&](std::size_t band) {
        ConcentrationProfile profile;
        const int v0 = static_cast<int>(band) * k_square;
        const int v1 = std::min(v0 + k_square, rays_.height());
        for (int u0 = 0; u0 < rays_.width(); u0 += k_square) {
            const int u1 = std::min(u0 + k_square, rays_.width());
            for (int v = v0; v < v1; v += apart) {
                for (int u = u0; u < u1; u += apart) {
                    if (rays_(u, v).traced() || !wanted(u, v, apart)) continue;
                    throw_if_stopped();
                    march(u, v, profile);
                    store(profile, tolerance, rows_[static_cast<std::size_t>(v)], rays_(u, v));
                }
            }
        }
    });
}

// Whether a square around the texel still needs rays `apart` from each other, this one included.
bool ColumnFace::wanted(int u, int v, int apart) const {
    // Directions end at the rectangle's last texels.
    if (u - apart >= width_ - 1 || v - apart >= height_ - 1) return false;
    const int right = std::min(u / k_square, spacing_.width() - 1);
    const int below = std::min(v / k_square, spacing_.height() - 1);
    const int left = std::max(0, (u - 1) / k_square), above = std::max(0, (v - 1) / k_square);
    return spacing_(left, above) == 0 || spacing_(right, above) == 0 ||
           spacing_(left, below) == 0 || spacing_(right, below) == 0;
}

// Resamples a profile's columns at equal steps from where they start to where they end.
void ColumnFace::store(const ConcentrationProfile& profile, const DepthTolerance& tolerance,
                       std::vector<float>& samples, TexelRay& ray) const {
    ray = {};
    ray.step = 0;
    const Filled part = filled(profile);
    if (part.first == part.last) return;
    ray.offset = static_cast<std::uint32_t>(samples.size());
    const double length = profile.s[part.last] - profile.s[part.first];
    double step = tolerance.exact() ? step_ : k_longest_steps * step_;
    std::size_t count = 0;
    while (true) {
        count = static_cast<std::size_t>(std::ceil(length / step));
        resample(profile, part, count, samples);
        if (step <= step_ ||
            follows(profile, part, count, &samples[ray.offset], reference_, tolerance))
            break;
        samples.resize(ray.offset);
        step *= 0.5;
    }
    ray.begin = static_cast<float>(profile.s[part.first]);
    ray.step = static_cast<float>(length / static_cast<double>(count));
    ray.count = static_cast<std::uint32_t>(count + 1);
}

// Whether interpolation between rays 2 `apart` from each other agrees with those between them.
bool ColumnFace::confirmed(int square_u, int square_v, int apart,
                           const DepthTolerance& tolerance) const {
    const int u0 = square_u * k_square, v0 = square_v * k_square;
    for (int v = v0; v <= v0 + k_square; v += apart)
        for (int u = u0; u <= u0 + k_square; u += apart)
            if (((u | v) & apart) != 0 && rays_(u, v).traced() && !agree(u, v, apart, tolerance))
                return false;
    return true;
}

bool ColumnFace::agree(int u, int v, int apart, const DepthTolerance& tolerance) const {
    std::vector<double> mixed(constituents_), traced(constituents_);
    const TexelRay& ray = rays_(u, v);
    const auto agree_at = [&](double distance) {
        std::fill(mixed.begin(), mixed.end(), 0.0);
        std::fill(traced.begin(), traced.end(), 0.0);
        add_corners(u, v, 2 * apart, distance, mixed);
        add_ray(u, v, distance, 1, traced);
        const double weight = weight_at(distance, reference_);
        for (std::size_t k = 0; k < constituents_; ++k) mixed[k] = weight * (mixed[k] - traced[k]);
        return tolerance.allows(mixed, 0, traced);
    };
    for (std::uint32_t i = 0; i < ray.count; ++i)
        if (!agree_at(static_cast<double>(ray.begin) + i * static_cast<double>(ray.step)))
            return false;
    // The columns must agree behind all samples, too.
    return agree_at(std::numeric_limits<double>::max());
}

void ColumnFace::add_ray(int u, int v, double distance, double weight,
                         std::span<double> column) const {
    const TexelRay& ray = rays_(u, v);
    if (ray.count == 0) return;
    const double at = (distance - static_cast<double>(ray.begin)) / static_cast<double>(ray.step);
    if (at <= 0) return;
    const auto last = static_cast<double>(ray.count - 1);
    const double clamped = std::min(at, last);
    const auto i = static_cast<std::size_t>(std::min(clamped, last - 1));
    const double t = clamped - static_cast<double>(i);
    const float* sample =
        rows_[static_cast<std::size_t>(v)].data() + ray.offset + i * constituents_;
    const float* next = sample + constituents_;
    for (std::size_t k = 0; k < constituents_; ++k)
        column[k] +=
            weight * ((1 - t) * static_cast<double>(sample[k]) + t * static_cast<double>(next[k]));
}

// Interpolates between the rays `apart` from each other around (u, v).
void ColumnFace::add_corners(double u, double v, int apart, double distance,
                             std::span<double> column) const {
    const int u0 = static_cast<int>(u) / apart * apart, v0 = static_cast<int>(v) / apart * apart;
    const double fu = (u - u0) / apart, fv = (v - v0) / apart;
    const std::array<double, 2> across{1 - fu, fu}, down{1 - fv, fv};
    for (int j = 0; j < 2; ++j) {
        for (int i = 0; i < 2; ++i) {
            const double weight =
                across[static_cast<std::size_t>(i)] * down[static_cast<std::size_t>(j)];
            if (weight > 0) add_ray(u0 + i * apart, v0 + j * apart, distance, weight, column);
        }
    }
}

void ColumnFace::add(double u, double v, double distance, std::span<double> column) const {
    if (!(u >= 0 && v >= 0 && u <= width_ - 1 && v <= height_ - 1)) return;
    const int square_u = std::min(static_cast<int>(u) / k_square, spacing_.width() - 1);
    const int square_v = std::min(static_cast<int>(v) / k_square, spacing_.height() - 1);
    // At the far edge of the last square the weights of the rays beyond are zero.
    add_corners(u, v, spacing_(square_u, square_v), distance, column);
}

int ColumnFace::spacing(double u, double v) const {
    if (!(u >= 0 && v >= 0 && u < width_ - 1 && v < height_ - 1)) return 0;
    const int apart = spacing_(static_cast<int>(u) / k_square, static_cast<int>(v) / k_square);
    const int u0 = static_cast<int>(u) / apart * apart, v0 = static_cast<int>(v) / apart * apart;
    for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 2; ++i)
            if (rays_(u0 + i * apart, v0 + j * apart).count > 0) return apart;
    return 0;
}

std::size_t ColumnFace::bytes() const {
    std::size_t total = rays_.size() * sizeof(TexelRay);
    for (const std::vector<float>& row : rows_) total += row.size() * sizeof(float);
    return total;
}

std::uint64_t ColumnFace::rays_traced() const {
    return static_cast<std::uint64_t>(
        std::count_if(rays_.begin(), rays_.end(), [](const TexelRay& r) { return r.traced(); }));
}

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

ColumnMap::ColumnMap(const ConcentrationField& of, const Point3& lamp, double per_voxel,
                     std::size_t memory_budget, const DepthTolerance& tolerance)
    : lamp_(lamp),
      per_voxel_(per_voxel),
      constituents_(static_cast<std::size_t>(of.constituent_count())),
      strata_(of.strata()) {
    const ConcentrationField& field = of.grids();
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
                           const FaceRectangle& rectangle, double max_distance, double reference,
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
        field.profile_within(tolerance, {lamp_, glm::normalize(face.direction(u, v))}, max_distance,
                             profile);
    };
    out.columns = ColumnFace(last(rectangle.u_max) - out.u0 + 1, last(rectangle.v_max) - out.v0 + 1,
                             field.constituent_count(), step_, reference, tolerance, march);
}

void ColumnMap::columns(std::span<const Point3> x, std::span<double> column) const {
    std::fill(column.begin(), column.end(), 0.0);
    if (strata_)
        for (std::size_t i = 0; i < x.size(); ++i)
            strata_->add_column(lamp_, x[i], column.subspan(i * constituents_, constituents_));
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
    std::vector<FaceSegment> segments;
    split_by_face(ray, lamp_, interval, segments);
    for (const FaceSegment& segment : segments) {
        const Face& face = faces_[static_cast<std::size_t>(segment.face)];
        if (face.columns.empty()) continue;
        const CubeFace projection(segment.face);
        const Vector3 a = ray.at(segment.interval.begin) - lamp_;
        const Vector3 b = ray.at(segment.interval.end) - lamp_;
        const double depth_a = projection.depth(a), depth_b = projection.depth(b);
        if (!(depth_a > 0 && depth_b > 0)) continue;
        const double ua = texel_u(projection.u(a)) - face.u0,
                     ub = texel_u(projection.u(b)) - face.u0;
        const double va = texel_u(projection.v(a)) - face.v0,
                     vb = texel_u(projection.v(b)) - face.v0;
        const double texels = std::max(std::abs(ub - ua), std::abs(vb - va));
        s.push_back(segment.interval.begin);
        for (double t = 0; t < 1;) {
            const int spacing = face.columns.spacing(ua + t * (ub - ua), va + t * (vb - va));
            t += std::max(1.0, per_voxel_) * std::max(1, spacing) / texels;
            // Equal steps on the face are not equal steps in space: interpolate s / depth.
            if (spacing > 0 && t < 1)
                s.push_back((segment.interval.begin * depth_b * (1 - t) +
                             segment.interval.end * depth_a * t) /
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

namespace {

constexpr int k_max_texels = 1 << 14;  // along an edge

}  // namespace

SunColumnMap::SunColumnMap(const ConcentrationField& of, const Sunlight& sun, double per_voxel,
                           std::size_t memory_budget, const DepthTolerance& tolerance)
    : frame_(sun),
      per_voxel_(per_voxel),
      constituents_(static_cast<std::size_t>(of.constituent_count())),
      strata_(of.strata()) {
    const ConcentrationField& field = of.grids();
    const Bounds bounds = field.bounds();
    if (bounds.empty() || constituents_ == 0) return;
    constexpr double k_none = std::numeric_limits<double>::infinity();
    LightPoint least{k_none, k_none, k_none};
    LightPoint most{-k_none, -k_none, -k_none};
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
         std::max(most.u - least.u, most.v - least.v) / (fine * k_max_texels)});
    texel_ = coarsening * fine;
    // The map has a border of one texel for interpolation.
    first_ = {least.u - texel_, least.v - texel_, least.depth};
    width_ = static_cast<int>(std::ceil((most.u - least.u) / texel_)) + 3;
    height_ = static_cast<int>(std::ceil((most.v - least.v) / texel_)) + 3;
    const auto march = [&](int x, int y, ConcentrationProfile& profile) {
        const double u = first_.u + x * texel_, v = first_.v + y * texel_;
        // Only the part below the surface counts if a field extends out of the water.
        const double begin = std::clamp(frame_.entry_depth(u, v), first_.depth, most.depth);
        field.profile_within(tolerance, {frame_.world({u, v, begin}), sun.direction},
                             most.depth - begin + texel_, profile);
        for (double& s : profile.s) s += begin - first_.depth;
    };
    // A sun's light does not fall with distance: an error counts the same at all distances.
    face_ = ColumnFace(width_, height_, field.constituent_count(), texel_, 0, tolerance, march);
}

void SunColumnMap::columns(std::span<const Point3> x, std::span<double> column) const {
    std::fill(column.begin(), column.end(), 0.0);
    if (strata_)
        for (std::size_t i = 0; i < x.size(); ++i)
            strata_->add_column(frame_.sun().entry(x[i]), x[i],
                                column.subspan(i * constituents_, constituents_));
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
