#include "core/light/sun_focus.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/geometry/waves.h"

namespace uw {

namespace {

constexpr int k_depth_slices = 48;
constexpr int k_beams_of_texel = 3;  // along each side

/// A beam of light where it enters the water, at depth 0. Single precision is an error of 1e-7 of a
/// shift by some metres, and halves the memory that the sum at each depth reads.
struct Beam {
    float u = 0, v = 0;              // of its place at depth 0, less the grid's [texels]
    float slope_u = 0, slope_v = 0;  // per metre of depth, less the mean ones [texels/m]
    float flux = 0;                  // relative to what calm water lets through
};

/// The greatest whole number <= x, which fits an int.
double whole_below(double x) {
    const double whole = static_cast<int>(x);
    return whole > x ? whole - 1 : whole;
}

/// Light that enters the water through a slope of its surface.
struct Entry {
    Vector3 down;  // direction of travel below, in the surface's coordinates, unit
    double flux =
        0;  // through a level area, relative to the irradiance across the light in the air
};

/// Refracts light at a slope; none where the slope faces away from the light. `in_air`: direction
/// of the light, in the surface's coordinates; `normal`: out of the water.
std::optional<Entry> enter(const WaterSurface& surface, const Vector3& in_air,
                           const Vector3& normal) {
    const double towards = -glm::dot(in_air, normal);
    if (!(towards > 0)) return std::nullopt;
    const std::optional<Vector3> down = surface.refracted_into_water(in_air, normal);
    if (!down || !(down->z < 0)) return std::nullopt;
    return Entry{*down, towards / normal.z * (1 - surface.reflectance_from_air(towards))};
}

/// The mean direction of the refracted light, weighted by flux, unit: over slopes that are normally
/// distributed with the waves' variances (Cox and Munk 1954), so that it is the same at all times,
/// and a sun's shadow maps stay valid while waves move.
Vector3 mean_direction(const WaterSurface& surface, const Vector3& in_air) {
    constexpr int k_steps =
        24;  // to each side; the integrand is smooth except at the shadow's edge
    constexpr double k_extent = 4.5;  // standard deviations
    const SlopeVariance slopes = surface.waves()->statistics().slopes;
    // The Cholesky factor of the covariance matrix.
    const double u_by_x = std::sqrt(slopes.along);
    const double v_by_x = u_by_x > 0 ? slopes.covariance / u_by_x : 0;
    const double v_by_y = std::sqrt(std::max(0.0, slopes.across - v_by_x * v_by_x));
    Vector3 sum{0};
    for (int j = -k_steps; j <= k_steps; ++j)
        for (int i = -k_steps; i <= k_steps; ++i) {
            const double x = k_extent * i / k_steps, y = k_extent * j / k_steps;
            const WavePoint point{0, u_by_x * x, v_by_x * x + v_by_y * y};
            if (const std::optional<Entry> entry = enter(surface, in_air, point.normal()))
                sum += std::exp(-0.5 * (x * x + y * y)) * entry->flux * entry->down;
        }
    return glm::normalize(sum);
}

/// A column or line of a map that repeats after `count` of them.
int wrapped(int i, int count) {
    if (i >= 0 && i < count) return i;  // nearly all: a division would take longer than the rest
    return (i % count + count) % count;
}

/// The weights with which flux is splatted onto the three texels around: a quadratic B-spline. A
/// uniform grid of beams lights all texels equally, also after beams have diverged or converged;
/// with the kinks of linear weights, some texels would receive a sixth more of any change.
struct SplineWeights {
    /// `x`: in texels from the centre of the first, of `count`. Those beyond have no weight unless
    /// the map repeats.
    SplineWeights(double x, int count, bool is_periodic) {
        const double nearest = std::floor(x + 0.5);
        const auto d = static_cast<float>(x - nearest);
        const int first = static_cast<int>(nearest) - 1;
        weights = {0.5F * (0.5F - d) * (0.5F - d), 0.75F - d * d, 0.5F * (0.5F + d) * (0.5F + d)};
        texels = {first, first + 1, first + 2};
        if (first >= 0 && first + 2 < count) return;
        for (std::size_t i = 0; i < texels.size(); ++i) {
            if (!is_periodic && (texels[i] < 0 || texels[i] >= count)) weights[i] = 0;
            texels[i] = wrapped(texels[i], count);
        }
    }

    std::array<int, 3> texels{};
    std::array<float, 3> weights{};
};

}  // namespace

SunFocus::SunFocus(const WaterSurface& surface, const Vector3& direction, double angle,
                   const Extent& extent, int resolution)
    : surface_(surface), extent_(extent), resolution_(resolution) {
    const WaterWaves& waves = *surface.waves();
    const Vector3 in_air = surface.in_plane(direction);
    const double calm_flux = -in_air.z * (1 - surface.reflectance_from_air(-in_air.z));
    const int beams_across = resolution * k_beams_of_texel;
    const double step = extent.side / beams_across, texels = resolution / extent.side;
    const auto place = [&](double centre, int i) {
        return centre + (i + 0.5) * step - 0.5 * extent.side;
    };
    Grid2D<Beam> beams;
    beams.assign(beams_across, beams_across);
    const Vector3 mean = mean_direction(surface, in_air);
    direction_ = mean.x * surface.across() + mean.y * surface.along() + mean.z * surface.up();
    shift_u_ = -mean.x / mean.z;
    shift_v_ = -mean.y / mean.z;
    first_u_ = (extent.u - 0.5 * extent.side) * texels + 0.5;
    first_v_ = (extent.v - 0.5 * extent.side) * texels + 0.5;
    parallel_for(static_cast<std::size_t>(beams_across), [&](std::size_t row) {
        throw_if_stopped();
        for (int i = 0; i < beams_across; ++i) {
            const WavePoint wave =
                waves.at(place(extent.u, i), place(extent.v, static_cast<int>(row)));
            const std::optional<Entry> entry = enter(surface, in_air, wave.normal());
            if (!entry) continue;
            const Vector3& down = entry->down;
            Beam& beam = beams(i, static_cast<int>(row));
            const double slope_u = -down.x / down.z, slope_v = -down.y / down.z;
            // The light enters at the wave's height, from where it goes down to depth 0.
            beam.u = static_cast<float>(texels * wave.height * slope_u);
            beam.v = static_cast<float>(texels * wave.height * slope_v);
            beam.slope_u = static_cast<float>(texels * (slope_u - shift_u_));
            beam.slope_v = static_cast<float>(texels * (slope_v - shift_v_));
            beam.flux =
                static_cast<float>(entry->flux / (calm_flux * k_beams_of_texel * k_beams_of_texel));
        }
    });
    slices_.resize(k_depth_slices + 1);
    const double radius = 0.5 * angle / surface.n();  // of the disc in the water, near the zenith
    parallel_for(slices_.size(), [&](std::size_t k) {
        throw_if_stopped();
        Grid2D<float>& slice = slices_[k];
        slice.assign(resolution_, resolution_);
        const double depth = depth_of(k);
        const auto place_in = [&](int i, float shift, float slope) {
            return SplineWeights((i + 0.5) / k_beams_of_texel - 0.5 + shift + depth * slope,
                                 resolution_, extent_.is_periodic);
        };
        for (int j = 0; j < beams_across; ++j) {
            for (int i = 0; i < beams_across; ++i) {
                const Beam& beam = beams(i, j);
                const SplineWeights across = place_in(i, beam.u, beam.slope_u);
                const SplineWeights down = place_in(j, beam.v, beam.slope_v);
                for (std::size_t l = 0; l < 3; ++l) {
                    const std::span<float> line = slice.row(down.texels[l]);
                    const float flux = beam.flux * down.weights[l];
                    for (std::size_t c = 0; c < 3; ++c)
                        line[static_cast<std::size_t>(across.texels[c])] +=
                            flux * across.weights[c];
                }
            }
        }
        blur(slice, depth * radius * texels);
    });
}

// A box filter whose variance is that of a disc of this radius [texels].
void SunFocus::blur(Grid2D<float>& slice, double radius) const {
    const double half = 0.5 * std::sqrt(3.0) * radius;
    if (half < 0.5) return;
    // Whole texels on each side, and a fraction of the next ones.
    const int whole = static_cast<int>(half - 0.5);
    const double part = half - 0.5 - whole;
    std::vector<double> line(static_cast<std::size_t>(resolution_));
    const auto at = [&](int i) {
        i = extent_.is_periodic ? (i % resolution_ + resolution_) % resolution_
                                : std::clamp(i, 0, resolution_ - 1);
        return line[static_cast<std::size_t>(i)];
    };
    const auto run = [&](const auto& cell) {
        for (int i = 0; i < resolution_; ++i)
            line[static_cast<std::size_t>(i)] = static_cast<double>(cell(i));
        for (int i = 0; i < resolution_; ++i) {
            double sum = part * (at(i - whole - 1) + at(i + whole + 1));
            for (int d = -whole; d <= whole; ++d) sum += at(i + d);
            cell(i) = static_cast<float>(sum / (2 * half));
        }
    };
    for (int j = 0; j < resolution_; ++j) run([&](int i) -> float& { return slice(i, j); });
    for (int i = 0; i < resolution_; ++i) run([&](int j) -> float& { return slice(i, j); });
}

double SunFocus::depth_of(std::size_t slice) const {
    const double fraction = static_cast<double>(slice) / k_depth_slices;
    return extent_.depth * fraction * fraction;
}

double SunFocus::slide(const Vector3& direction) const {
    const Vector3 v = surface_.in_plane(direction);
    return std::hypot(v.x + v.z * shift_u_, v.y + v.z * shift_v_);
}

SunFocus::Place SunFocus::place(const Vector3& at) const {
    const double texels = resolution_ / extent_.side;
    return {(at.x + at.z * shift_u_) * texels, (at.y + at.z * shift_v_) * texels, -at.z};
}

double SunFocus::at(const Point3& x) const {
    return factor(place(surface_.coordinates(x)));
}

void SunFocus::apply(const Ray& ray, std::span<const double> s, std::span<double> values) const {
    const Place from = place(surface_.coordinates(ray.origin));
    const Place per_metre = place(surface_.in_plane(ray.direction));
    for (std::size_t i = 0; i < s.size(); ++i)
        values[i] *= factor({from.u + s[i] * per_metre.u, from.v + s[i] * per_metre.v,
                             from.depth + s[i] * per_metre.depth});
}

// Interpolates linearly between the texels around, and between the depths above and below.
double SunFocus::factor(const Place& place) const {
    if (!(place.depth > 0)) return 1;
    double u = place.u - first_u_, v = place.v - first_v_;
    if (extent_.is_periodic) {
        u -= resolution_ * std::floor(u / resolution_);
        v -= resolution_ * std::floor(v / resolution_);
    } else if (!(u > -0.5 && v > -0.5 && u < resolution_ - 0.5 && v < resolution_ - 0.5)) {
        return 1;
    }
    // The texels whose centres lie below and above.
    const auto neighbours = [&](double at, double& fraction) {
        int first = static_cast<int>(whole_below(at));
        fraction = at - first;
        int second = first + 1;
        if (first < 0) first = extent_.is_periodic ? resolution_ - 1 : 0;
        if (first >= resolution_) first = extent_.is_periodic ? 0 : resolution_ - 1;  // by rounding
        if (second >= resolution_) second = extent_.is_periodic ? 0 : resolution_ - 1;
        return std::array{static_cast<std::size_t>(first), static_cast<std::size_t>(second)};
    };
    double across = 0, down = 0;
    const std::array<std::size_t, 2> columns = neighbours(u, across), rows = neighbours(v, down);
    // Slices lie at the squares of whole numbers (depth_of), and k^2 and (k + 1)^2 around this one.
    const double square =
        k_depth_slices * k_depth_slices * std::min(1.0, place.depth / extent_.depth);
    const int k = std::min(static_cast<int>(std::sqrt(square)), k_depth_slices - 1);
    const auto w = static_cast<float>((square - k * k) / (2 * k + 1));
    const auto s = static_cast<float>(across), t = static_cast<float>(down);
    const auto value = [&](const Grid2D<float>& slice) {
        const auto along = [&](std::size_t row) {
            const std::span<const float> line = slice.row(static_cast<int>(row));
            return (1 - s) * line[columns[0]] + s * line[columns[1]];
        };
        return (1 - t) * along(rows[0]) + t * along(rows[1]);
    };
    return static_cast<double>((1 - w) * value(slices_[static_cast<std::size_t>(k)]) +
                               w * value(slices_[static_cast<std::size_t>(k) + 1]));
}

}  // namespace uw
