#include "core/frame/multiple_light.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "core/base/error.h"
#include "core/base/fast_exp.h"
#include "core/base/parallel.h"
#include "core/frame/lattice_fit.h"
#include "core/surfaces/surface_reflection.h"

namespace uw {

namespace {

constexpr int k_intervals = 20;
// Optical depth beyond which nothing is seen, and a coarse lattice of rays that finds how far the
// image's surfaces are.
constexpr double k_reach_depth = 15;
constexpr int k_rays_across = 16;
// An interval that a surface cuts counts if this share of its light lies before it.
constexpr double k_least_share = 0.3;
// Differences between fits that do not matter, relative to the mean of all light.
constexpr double k_tolerance = 1e-3;
// Nodes see the same surface as a pixel if its normal is within 45 degrees of theirs and it lies
// as near to their tangent plane, relative to its distance.
constexpr double k_least_cosine = 0.7, k_most_slope = 0.35;
constexpr int k_search = 3;            // cells around a pixel without a match at its corners
constexpr int k_paths_of_sample = 64;  // where there is none at all

double lerp_weight(double t, int side) {
    return side == 0 ? 1 - t : t;
}

// A power of two, for about as many nodes.
int spacing_for(const RaySource& rays, int nodes) {
    const double area = static_cast<double>(rays.width()) * rays.height();
    int spacing = 1;
    while (area / (4.0 * spacing * spacing) > nodes) spacing *= 2;
    return spacing;
}

}  // namespace

MultipleLight::MultipleLight(const PixelRenderer& pixels, const MultipleLightOptions& options)
    : pixels_(pixels),
      bands_(static_cast<std::size_t>(pixels.band_count())),
      spacing_(spacing_for(pixels.rays(), options.nodes)),
      estimator_(
          pixels.rays(), pixels.scene(), pixels.transport(),
          {place_distances(), options.lamps ? static_cast<std::size_t>(pixels.lamp_count()) + 1 : 1,
           std::max(16, options.paths / options.nodes)}),
      attenuation_(*pixels.scene().medium) {}

// The same for every part of the image.
std::vector<double> MultipleLight::place_distances() const {
    const RaySource& rays = pixels_.rays();
    const LitScene& scene = pixels_.scene();
    double far = 0;
    bool is_open = false;
    for (int j = 0; j < k_rays_across; ++j) {
        for (int i = 0; i < k_rays_across; ++i) {
            const auto ray = rays.refracted_ray((i + 0.5) * rays.width() / k_rays_across,
                                                (j + 0.5) * rays.height() / k_rays_across);
            if (!ray) continue;
            const double distance = scene.surfaces->hit_distance(*ray);
            if (distance < k_far)
                far = std::max(far, distance);
            else
                is_open = true;
        }
    }
    const double c = scene.medium->uniform.attenuation().least(bands_);
    const double reach = c > 0 ? std::min(k_far, k_reach_depth / c) : k_far;
    double fine = far;  // of equal steps in the square root of the distance
    if (far == 0 || is_open) {
        for (const Lamp& lamp : *scene.lamps)
            if (const auto ray = rays.refracted_ray(0.5 * rays.width(), 0.5 * rays.height()))
                fine = std::max(fine, 2 * distance(ray->origin, lamp.position()));
        if (c > 0) fine = std::max(fine, std::min(reach, 3 / c));
    }
    fine = std::min(fine > 0 ? fine : reach, reach);
    std::vector<double> distances;
    for (int i = 0; i <= k_intervals; ++i) {
        const double share = static_cast<double>(i) / k_intervals;
        distances.push_back(fine * std::pow(share, 1.5));
    }
    while (distances.back() < reach) distances.push_back(std::min(reach, 1.5 * distances.back()));
    distances.back() = std::max(distances.back(), k_far);
    return distances;
}

// The share of the light of an interval, as of water that glows evenly, up to `distance`.
double MultipleLight::share_of_interval(std::size_t interval, std::size_t band,
                                        double distance) const {
    const double begin = estimator_.options().distances[interval];
    const double end = estimator_.options().distances[interval + 1];
    if (distance >= end) return 1;
    if (distance <= begin) return 0;
    const double c = attenuation_.uniform[band];
    if (c * (end - begin) < 1e-4) return (distance - begin) / (end - begin);
    return (1 - exp_of_minus(c * (distance - begin))) / (1 - exp_of_minus(c * (end - begin)));
}

void MultipleLight::prepare(const PixelWindow& window, const Progress& progress) {
    // The corners of all cells in the window, and what these are fitted to.
    constexpr int k_margin = LatticeFit::k_reach + k_search + 1;
    const RaySource& rays = pixels_.rays();
    column_ = std::max(0, window.x0 / spacing_ - k_margin);
    row_ = std::max(0, window.y0 / spacing_ - k_margin);
    const int last_column = std::min((rays.width() + spacing_ - 1) / spacing_,
                                     (window.x1 - 1) / spacing_ + 1 + k_margin);
    const int last_row = std::min((rays.height() + spacing_ - 1) / spacing_,
                                  (window.y1 - 1) / spacing_ + 1 + k_margin);
    const int columns = last_column - column_ + 1, rows = last_row - row_ + 1;
    Grid2D<MultipleNode> raw;
    raw.assign(columns, rows);
    std::atomic<std::size_t> done = 0;
    const std::size_t count = raw.size();
    parallel_for(count, [&](std::size_t at) {
        const int i = static_cast<int>(at) % columns, j = static_cast<int>(at) / columns;
        const auto column = static_cast<std::uint64_t>(column_ + i);
        const auto row = static_cast<std::uint64_t>(row_ + j);
        estimator_.estimate((column_ + i) * static_cast<double>(spacing_),
                            (row_ + j) * static_cast<double>(spacing_),
                            PathRandom::seed_of(column, row), raw(i, j));
        if (!progress(static_cast<double>(++done) / static_cast<double>(count)))
            throw Interrupted();
    });
    nodes_.assign(columns, rows);
    parallel_for(count, [&](std::size_t at) {
        const int i = static_cast<int>(at) % columns, j = static_cast<int>(at) / columns;
        smooth(i, j, raw, nodes_(i, j));
    });
    double variance = 0, light = 0;
    for (const MultipleNode& node : nodes_) {
        if (!node.has_ray) continue;
        light += node.mean_light;
        variance += node.diffuse_variance * node.surface_seen * node.surface_seen;
        for (const float of_interval : node.water_variance) variance += of_interval;
    }
    const auto all = static_cast<double>(nodes_.size());
    error_ = light > 0 ? std::sqrt(variance * all) / light : 0;
}

void MultipleLight::smooth(int i, int j, const Grid2D<MultipleNode>& raw,
                           MultipleNode& node) const {
    node = raw(i, j);
    node.has_ray = false;  // until something is known of it
    smooth_water(i, j, raw, node);
    if (node.surface) smooth_surface(i, j, raw, node);
}

void MultipleLight::smooth_water(int i, int j, const Grid2D<MultipleNode>& raw,
                                 MultipleNode& node) const {
    thread_local LatticeFit fit;
    thread_local std::vector<FitNode> near;
    const std::size_t intervals = estimator_.options().distances.size() - 1;
    const std::size_t values = estimator_.options().groups * bands_;
    constexpr int k_reach = LatticeFit::k_reach;
    node.water.assign(intervals * values, 0.0F);
    node.water_variance.assign(intervals, 0.0F);
    double known_to = 0;
    for (std::size_t interval = 0; interval < intervals; ++interval) {
        near.clear();
        double variance = 0, light = 0;
        for (int v = std::max(0, j - k_reach); v <= std::min(raw.height() - 1, j + k_reach); ++v) {
            for (int u = std::max(0, i - k_reach); u <= std::min(raw.width() - 1, i + k_reach);
                 ++u) {
                const MultipleNode& other = raw(u, v);
                if (!other.has_ray) continue;
                const double share = share_of_interval(interval, 0, other.reach);
                if (share < k_least_share) continue;
                near.push_back({u - i, v - j, other.water_mean[interval] / share,
                                other.water_variance[interval] / (share * share), raw.index(u, v)});
                variance += near.back().variance;
                light += other.mean_light;
            }
        }
        if (near.empty()) break;
        // Of four batches, a variance says little: that of the neighbourhood says more.
        variance /= static_cast<double>(near.size());
        light /= static_cast<double>(near.size());
        for (FitNode& other : near) other.variance = variance;
        for (const FitWeight& weight : fit.fit(near, k_tolerance * light)) {
            const MultipleNode& other = raw.values()[weight.index];
            for (std::size_t k = 0; k < values; ++k) {
                const double share = share_of_interval(interval, k % bands_, other.reach);
                node.water[interval * values + k] +=
                    static_cast<float>(weight.weight * other.water[interval * values + k] / share);
            }
        }
        node.water_variance[interval] = static_cast<float>(fit.variance());
        known_to = estimator_.options().distances[interval + 1];
    }
    node.has_ray = known_to > 0;
    // Light beyond its own surface was never there to be counted as noise.
    for (std::size_t interval = 0; interval < intervals; ++interval)
        if (estimator_.options().distances[interval] >= raw(i, j).reach)
            node.water_variance[interval] = 0;
    node.reach = known_to;
}

void MultipleLight::smooth_surface(int i, int j, const Grid2D<MultipleNode>& raw,
                                   MultipleNode& node) const {
    thread_local LatticeFit fit;
    thread_local std::vector<FitNode> near;
    constexpr int k_reach = LatticeFit::k_reach;
    near.clear();
    double variance = 0, light = 0;
    const NodeSurface& own = *node.surface;
    for (int v = std::max(0, j - k_reach); v <= std::min(raw.height() - 1, j + k_reach); ++v) {
        for (int u = std::max(0, i - k_reach); u <= std::min(raw.width() - 1, i + k_reach); ++u) {
            const MultipleNode& other = raw(u, v);
            if (!other.surface || other.surface->object_id != own.object_id) continue;
            if (other.surface->is_glossy != own.is_glossy) continue;
            if (glm::dot(other.surface->normal, own.normal) < k_least_cosine) continue;
            near.push_back(
                {u - i, v - j, other.diffuse_mean, other.diffuse_variance, raw.index(u, v)});
            variance += other.diffuse_variance;
            light += other.mean_light;
        }
    }
    variance /= static_cast<double>(near.size());
    for (FitNode& other : near) other.variance = variance;
    const double tolerance =
        k_tolerance * light / static_cast<double>(near.size()) / std::max(node.surface_seen, 1e-3);
    std::ranges::fill(node.diffuse, 0.0F);
    std::ranges::fill(node.glossy, 0.0F);
    for (const FitWeight& weight : fit.fit(near, tolerance)) {
        const MultipleNode& other = raw.values()[weight.index];
        for (std::size_t k = 0; k < node.diffuse.size(); ++k)
            node.diffuse[k] += static_cast<float>(weight.weight * other.diffuse[k]);
        for (std::size_t k = 0; k < node.glossy.size(); ++k)
            node.glossy[k] += static_cast<float>(weight.weight * other.glossy[k]);
    }
    node.diffuse_variance = fit.variance();
}

void MultipleLight::find_corners(double x, double y, std::vector<Corner>& corners) const {
    corners.clear();
    const double u = x / spacing_ - column_, v = y / spacing_ - row_;
    const int i = std::clamp(static_cast<int>(u), 0, nodes_.width() - 2);
    const int j = std::clamp(static_cast<int>(v), 0, nodes_.height() - 2);
    for (const int below : {0, 1})
        for (const int right : {0, 1})
            corners.push_back({&nodes_(i + right, j + below),
                               lerp_weight(u - i, right) * lerp_weight(v - j, below)});
}

void MultipleLight::give(std::size_t group, std::size_t band, double radiance,
                         PixelResult& result) const {
    if (group < result.lamps.size()) result.lamps[group][band] += radiance;
}

void MultipleLight::add_water(const PixelView& view, PixelResult& result) const {
    thread_local std::vector<Corner> corners;
    find_corners(view.x, view.y, corners);
    const std::size_t intervals = estimator_.options().distances.size() - 1;
    const std::size_t groups = estimator_.options().groups;
    for (std::size_t d = 0; d < view.distances.size(); ++d) {
        for (std::size_t interval = 0; interval < intervals; ++interval) {
            const double begin = estimator_.options().distances[interval];
            if (begin >= view.distances[d]) break;
            double total = 0;
            for (const Corner& corner : corners)
                if (corner.node->reach > begin) total += corner.weight;
            if (!(total > 0)) break;
            for (std::size_t b = 0; b < bands_; ++b) {
                const double share =
                    view.weights[d] / total * share_of_interval(interval, b, view.distances[d]);
                for (std::size_t group = 0; group < groups; ++group) {
                    double sum = 0;
                    for (const Corner& corner : corners)
                        if (corner.node->reach > begin)
                            sum += corner.weight *
                                   corner.node->water[(interval * groups + group) * bands_ + b];
                    result.multiple_volume[b] += share * sum;
                    give(group, b, share * sum, result);
                }
            }
        }
    }
}

// The corners that see the surface; if none does, nodes around them, by nearness.
void MultipleLight::find_matches(double x, double y, const SurfaceHit& hit,
                                 std::vector<Corner>& matches) const {
    const auto sees = [&](const MultipleNode& node) {
        if (!node.surface || node.surface->object_id != hit.object_id) return false;
        const NodeSurface& surface = *node.surface;
        if (glm::dot(surface.normal, hit.normal) < k_least_cosine) return false;
        const Vector3 between = hit.position - surface.position;
        return std::abs(glm::dot(between, surface.normal)) <= k_most_slope * glm::length(between);
    };
    find_corners(x, y, matches);
    std::erase_if(matches,
                  [&](const Corner& corner) { return corner.weight <= 0 || !sees(*corner.node); });
    if (!matches.empty()) return;
    const double u = x / spacing_ - column_, v = y / spacing_ - row_;
    for (int reach = 1; reach <= k_search && matches.empty(); ++reach) {
        for (int j = std::max(0, static_cast<int>(v) - reach);
             j <= std::min(nodes_.height() - 1, static_cast<int>(v) + 1 + reach); ++j) {
            for (int i = std::max(0, static_cast<int>(u) - reach);
                 i <= std::min(nodes_.width() - 1, static_cast<int>(u) + 1 + reach); ++i) {
                if (!sees(nodes_(i, j))) continue;
                const double square = (i - u) * (i - u) + (j - v) * (j - v);
                matches.push_back({&nodes_(i, j), 1 / (square * square + 1e-6)});
            }
        }
    }
}

void MultipleLight::add_surface(const SurfaceSample& sample, std::span<const double> to_camera,
                                PixelResult& result) const {
    thread_local std::vector<Corner> matches;
    thread_local MultipleNode own;
    find_matches(sample.x, sample.y, sample.hit, matches);
    if (matches.empty()) {
        // Too small for the lattice.
        estimator_.estimate_surface(sample, k_paths_of_sample, own);
        matches.push_back({&own, 1});
    }
    double total = 0;
    for (const Corner& match : matches) total += match.weight;
    const SurfaceReflection reflection(*pixels_.scene().surfaces, sample, static_cast<int>(bands_));
    const double weight = 1.0 / (total * pixels_.samples());
    for (std::size_t group = 0; group < estimator_.options().groups; ++group) {
        for (std::size_t b = 0; b < bands_; ++b) {
            double diffuse = 0, glossy = 0;
            for (const Corner& match : matches) {
                diffuse += match.weight * match.node->diffuse[group * bands_ + b];
                if (!match.node->glossy.empty())
                    glossy += match.weight * match.node->glossy[group * bands_ + b];
            }
            double reflected = sample.hit.reflectance[b] * diffuse;
            if (reflection.is_glossy()) reflected += glossy;
            const double radiance = weight * to_camera[b] * reflected;
            result.multiple_surface[b] += radiance;
            give(group, b, radiance, result);
        }
    }
}

void MultipleLight::add(const PixelView& view, const SurfaceLight& light, std::size_t first_sample,
                        PixelResult& result) const {
    if (!view.ray) return;
    add_water(view, result);
    for (std::size_t i = 0; i < view.samples.size(); ++i)
        add_surface(view.samples[i], light.to_camera(first_sample + i), result);
}

}  // namespace uw
