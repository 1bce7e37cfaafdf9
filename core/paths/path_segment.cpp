#include "core/paths/path_segment.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/error.h"
#include "core/base/numerics.h"
#include "core/light/integrator.h"

namespace uw {

namespace {

constexpr std::size_t k_lanes = 4;  // doubles in the widest common registers
static_assert(k_max_bands % k_lanes == 0);

bool crosses(const Bounds& bounds, const Ray& ray, double length) {
    if (bounds.empty()) return false;
    double begin = 0, end = length;
    for (int axis = 0; axis < 3; ++axis) {
        const double d = ray.direction[axis];
        const double to_min = bounds.min[axis] - ray.origin[axis];
        const double to_max = bounds.max[axis] - ray.origin[axis];
        if (d == 0) {
            if (to_min > 0 || to_max < 0) return false;
            continue;
        }
        begin = std::max(begin, std::min(to_min / d, to_max / d));
        end = std::min(end, std::max(to_min / d, to_max / d));
    }
    return begin < end;
}

// The last knot not beyond `distance` that has one after it.
std::size_t knot_before(const ConcentrationProfile& profile, double distance) {
    const auto above = std::upper_bound(profile.s.begin() + 1, profile.s.end() - 1, distance);
    return static_cast<std::size_t>(above - profile.s.begin()) - 1;
}

}  // namespace

WaterOptics::WaterOptics(const LitScene& scene, bool exact)
    : scene_(scene),
      attenuation_(*scene.medium),
      exact_(exact),
      bands_(static_cast<std::size_t>(scene.medium->band_count())),
      bounds_(scene.field->bounds()) {
    const std::span<const double> c = attenuation_.uniform.first(bands_);
    clearest_band_ = static_cast<std::size_t>(std::ranges::min_element(c) - c.begin());
}

void WaterOptics::trace(const Ray& ray, WaterSegment& segment) const {
    throw_if_stopped();
    const bool found = scene_.surfaces->closest_hit(ray, k_far, segment.hit);
    set(ray, found ? &segment.hit : nullptr, segment);
}

void WaterOptics::set(const Ray& ray, const SurfaceHit* hit, WaterSegment& segment) const {
    segment.ray = ray;
    segment.has_hit = hit != nullptr;
    segment.length = hit ? hit->distance : k_far;
    if (hit && hit != &segment.hit) segment.hit = *hit;
    segment.profile.s.clear();
    segment.has_field = crosses(bounds_, ray, segment.length);
    if (!segment.has_field) return;
    if (exact_)
        scene_.field->profile(ray, segment.length, segment.profile);
    else
        scene_.field->coarse_profile(ray, segment.length, segment.profile);
}

void WaterOptics::look_up(const WaterSegment& segment, double distance, WaterPoint& point) const {
    const std::size_t count = constituents();
    point.distance = distance;
    point.concentration.assign(count, 0.0);
    point.column.assign(count, 0.0);
    if (!segment.has_field) return;
    const ConcentrationProfile& profile = segment.profile;
    if (profile.s.empty()) {
        const Point3 x = segment.ray.at(distance);
        scene_.field->sample(x, point.concentration);
        scene_.field->column(segment.ray.origin, x, point.column);
        return;
    }
    const std::size_t knot = knot_before(profile, distance);
    const double length = profile.s[knot + 1] - profile.s[knot];
    const double t = std::clamp((distance - profile.s[knot]) / length, 0.0, 1.0);
    for (std::size_t k = 0; k < count; ++k) {
        const std::size_t at = knot * count + k;
        const double begin = profile.concentration[at];
        const double rise = profile.concentration[at + count] - begin;
        point.concentration[k] = begin + t * rise;
        point.column[k] = profile.column[at] + t * length * (begin + 0.5 * t * rise);
    }
}

void WaterOptics::find_scattering(WaterPoint& point) const {
    const Medium& medium = *scene_.medium;
    point.scattering = medium.uniform.scattering;
    if (std::ranges::all_of(point.concentration, [](double value) { return value == 0; })) return;
    point.mixed.resize(medium.phase_functions.size());
    point.scattering = point.mixed;
    for (std::size_t m = 0; m < point.mixed.size(); ++m) {
        const std::span<double> b = point.mixed[m].first(bands_);
        std::ranges::copy(medium.uniform.scattering[m].first(bands_), b.begin());
        for (std::size_t k = 0; k < point.concentration.size(); ++k)
            if (point.concentration[k] != 0)
                add_scaled(b, point.concentration[k],
                           medium.constituents[k].per_unit.scattering[m].first(bands_));
    }
}

void WaterOptics::attenuations(const WaterPoint& point, std::span<double> c) const {
    for (std::size_t b = 0; b < bands_; ++b)
        c[b] = attenuation_.optical_depth(b, 1, point.concentration);
}

UWVDB_VECTOR_CLONES void WaterOptics::transmittances(double length, std::span<const double> columns,
                                                     Spectrum& values) const {
    for (std::size_t first = 0; first < bands_; first += k_lanes) {
        std::array<double, k_lanes> tau{};
        for (std::size_t i = 0; i < k_lanes; ++i) tau[i] = attenuation_.uniform[first + i] * length;
        for (std::size_t k = 0; k < columns.size(); ++k)
            for (std::size_t i = 0; i < k_lanes; ++i)
                tau[i] += attenuation_.constituents[k][first + i] * columns[k];
        for (std::size_t i = 0; i < k_lanes; ++i) values[first + i] = exp_of_minus(tau[i]);
    }
}

UWVDB_VECTOR_CLONES double WaterOptics::attenuated_sum(const Spectrum& a, const Spectrum& b,
                                                       double length) const {
    std::array<double, k_lanes> sums{};
    for (std::size_t first = 0; first < bands_; first += k_lanes)
        for (std::size_t i = 0; i < k_lanes; ++i)
            sums[i] += a[first + i] * b[first + i] *
                       exp_of_minus(attenuation_.uniform[first + i] * length);
    return (sums[0] + sums[1]) + (sums[2] + sums[3]);
}

double WaterOptics::depth_at_knot(const WaterSegment& segment, std::size_t band,
                                  std::size_t knot) const {
    const std::size_t count = constituents();
    return attenuation_.optical_depth(
        band, segment.profile.s[knot],
        std::span(segment.profile.column).subspan(knot * count, count));
}

double WaterOptics::distance_at_depth(const WaterSegment& segment, std::size_t band,
                                      double depth) const {
    const double c0 = attenuation_.uniform[band];
    const ConcentrationProfile& profile = segment.profile;
    if (profile.s.empty()) return c0 * segment.length > depth ? depth / c0 : segment.length;
    // Bisects for the last knot at which the optical depth is not greater.
    std::size_t low = 0, high = profile.s.size() - 1;
    if (depth_at_knot(segment, band, high) <= depth) return segment.length;
    while (high - low > 1) {
        const std::size_t middle = (low + high) / 2;
        (depth_at_knot(segment, band, middle) <= depth ? low : high) = middle;
    }
    const std::size_t count = constituents();
    double begin = c0, end = c0;  // attenuation at the two knots
    for (std::size_t k = 0; k < count; ++k) {
        begin += attenuation_.constituents[k][band] * profile.concentration[low * count + k];
        end += attenuation_.constituents[k][band] * profile.concentration[high * count + k];
    }
    const double length = profile.s[high] - profile.s[low];
    const double rest = depth - depth_at_knot(segment, band, low);
    // Solves rest = begin t + (end - begin) t^2 / (2 length) for t, in a form without cancellation.
    const double root = std::sqrt(std::max(0.0, begin * begin + 2 * (end - begin) / length * rest));
    return profile.s[low] + (begin + root > 0 ? std::min(length, 2 * rest / (begin + root)) : 0.0);
}

}  // namespace uw
