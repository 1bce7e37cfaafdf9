#include "core/passes/multiple_scattering.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/geometry/surface_reflection.h"

namespace uw {

namespace {

// A node sees the same surface as a pixel if their normals agree (k_min_node_cosine) and the
// pixel's point lies within this distance of the node's tangent plane, relative to the distance of
// the two points.
constexpr double k_max_slope = 0.35;
constexpr double k_min_cosine_of_match = 0.7;  // of normals, if no node reaches k_min_node_cosine
constexpr int k_paths_of_sample = 32;          // of a sample that no node matches
// Records of the cache within this distance serve for it, relative to the distance of the camera.
constexpr double k_max_distance_in_cache = 0.05;
constexpr int k_mirrored_paths = 8;  // of a pixel with glossy surfaces

double lerp_weight(double t, int side) {
    return side == 0 ? 1 - t : t;
}

}  // namespace

/// Standard errors of the light of a pixel, by band.
struct MultipleScattering::Errors {
    Spectrum water;     // of in-scattered light from the nodes
    Spectrum surfaces;  // of indirect light on surfaces, visible directly or as halo
    // Sums, over the pixel's own paths, of the light that glossy surfaces mirror, and of its
    // squares.
    Spectrum mirrored, mirrored_squares;
    double mirrored_paths = 0;

    double of_band(std::size_t b) const {
        const double sum = mirrored[b];
        const double spread =
            mirrored_paths > 1 ? std::max(0.0, mirrored_squares[b] - sum * sum / mirrored_paths) *
                                     mirrored_paths / (mirrored_paths - 1)
                               : 0;
        return std::sqrt(water[b] * water[b] + surfaces[b] * surfaces[b] + spread);
    }
};

MultipleScattering::MultipleScattering(const PixelRenderer& pixels,
                                       std::shared_ptr<const CameraRadianceCache> cache,
                                       const PixelWindow& window)
    : pixels_(pixels),
      cache_(std::move(cache)),
      bands_(static_cast<std::size_t>(pixels.band_count())),
      weights_(pixels.scene(), cache_->intervals()),
      estimator_(pixels.rays(), pixels.scene(), pixels.transport(), weights_, cache_->groups()),
      weight_lattice_(pixels.rays(), weights_, window) {}

MultipleScattering::MultipleScattering(const PixelRenderer& pixels,
                                       std::shared_ptr<const CameraRadianceCache> cache,
                                       const PixelWindow& window, SurfaceHalo halo)
    : MultipleScattering(pixels, std::move(cache), window) {
    halo_ = std::move(halo);
}

void MultipleScattering::find_corners(double x, double y, std::vector<Corner>& corners) const {
    corners.clear();
    const Grid2D<SmoothNode>& nodes = cache_->nodes();
    const double u = x / cache_->spacing(), v = y / cache_->spacing();
    const int i = std::clamp(static_cast<int>(u), 0, nodes.width() - 2);
    const int j = std::clamp(static_cast<int>(v), 0, nodes.height() - 2);
    for (const int below : {0, 1})
        for (const int right : {0, 1})
            corners.push_back({&nodes(i + right, j + below),
                               lerp_weight(u - i, right) * lerp_weight(v - j, below)});
}

void MultipleScattering::add_to_lamp(std::size_t group, std::size_t band, double radiance,
                                     PixelResult& result) const {
    if (group < result.lamps.size()) result.lamps[group][band] += radiance;
}

void MultipleScattering::add_water(const PixelView& view, std::span<double> light,
                                   Errors& errors) const {
    std::vector<Corner> corners;
    std::vector<float> weights;
    std::vector<double> of_surfaces;
    const SurfaceHalo& halo = halo_ ? *halo_ : cache_->halo();
    Spectrum scattered{};  // of uniform light, by the water up to each distance
    weight_lattice_.find(view.x, view.y, weights);
    find_corners(view.x, view.y, corners);
    const DistanceIntervals& intervals = cache_->intervals();
    const std::size_t groups = cache_->groups();
    for (std::size_t d = 0; d < view.distances.size(); ++d) {
        Spectrum up_to_distance{};
        for (std::size_t interval = 0; interval < intervals.count(); ++interval) {
            const double begin = intervals.begin(interval);
            if (begin >= view.distances[d]) break;
            double total = 0;
            for (const Corner& corner : corners)
                if (corner.node->known_to > begin) total += corner.weight;
            if (!(total > 0)) break;
            for (std::size_t b = 0; b < bands_; ++b) {
                const double weight = static_cast<double>(weights[interval * bands_ + b]) *
                                      intervals.fraction_before(interval, b, view.distances[d]);
                const double scale = view.weights[d] * weight / total;
                up_to_distance[b] += weight;
                for (std::size_t group = 0; group < groups; ++group) {
                    double sum = 0;
                    for (const Corner& corner : corners)
                        if (corner.node->known_to > begin)
                            sum +=
                                corner.weight *
                                corner.node->light.water[(interval * groups + group) * bands_ + b];
                    light[group * bands_ + b] += scale * sum;
                }
            }
        }
        of_surfaces.assign(light.size(), 0.0);
        halo.add(view.x, view.y, view.distances[d], view.weights[d], of_surfaces);
        for (std::size_t k = 0; k < light.size(); ++k)
            light[k] += of_surfaces[k] *
                        halo.fraction(up_to_distance[k % bands_], view.distances[d], k % bands_);
        for (std::size_t b = 0; b < bands_; ++b)
            scattered[b] += view.weights[d] * up_to_distance[b];
    }
    // Neighbouring nodes were smoothed together, so their errors are correlated and add up
    // linearly.
    for (std::size_t b = 0; b < bands_; ++b) {
        for (const Corner& corner : corners) {
            errors.water[b] +=
                corner.weight * scattered[b] * static_cast<double>(corner.node->water_error[b]);
            errors.surfaces[b] += corner.weight * static_cast<double>(corner.node->halo_error[b]);
        }
    }
}

// The nodes store light minus halo, a noisy difference, so that the sum may come out negative:
// clamp it.
void MultipleScattering::add_volume(const PixelView& view, PixelResult& result,
                                    Errors& errors) const {
    const std::size_t groups = cache_->groups();
    std::vector<double> light(groups * bands_, 0.0);
    add_water(view, light, errors);
    for (std::size_t group = 0; group < groups; ++group) {
        for (std::size_t b = 0; b < bands_; ++b) {
            const double radiance = std::max(0.0, light[group * bands_ + b]);
            result.multiple_volume[b] += radiance;
            add_to_lamp(group, b, radiance, result);
        }
    }
}

// Finds the corners that see the surface or, if none does, nodes around them, weighted by 1 /
// distance^4. If no node has a similar normal, larger differences are accepted: on rough ground the
// nodes do not cover all normals.
void MultipleScattering::find_matches(double x, double y, const SurfaceHit& hit,
                                      std::vector<Corner>& matches) const {
    for (const double min_cosine : {k_min_node_cosine, k_min_cosine_of_match}) {
        find_matches(x, y, hit, min_cosine, matches);
        if (!matches.empty()) return;
    }
}

void MultipleScattering::find_matches(double x, double y, const SurfaceHit& hit, double min_cosine,
                                      std::vector<Corner>& matches) const {
    const auto sees = [&](const SmoothNode& node) {
        if (!node.surface || node.surface->object_id != hit.object_id) return false;
        const NodeSurface& surface = *node.surface;
        if (glm::dot(surface.normal, hit.normal) < min_cosine) return false;
        const Vector3 between = hit.position - surface.position;
        return std::abs(glm::dot(between, surface.normal)) <= k_max_slope * glm::length(between);
    };
    find_corners(x, y, matches);
    std::erase_if(matches,
                  [&](const Corner& corner) { return corner.weight <= 0 || !sees(*corner.node); });
    if (!matches.empty()) return;
    const Grid2D<SmoothNode>& nodes = cache_->nodes();
    const double u = x / cache_->spacing(), v = y / cache_->spacing();
    for (int radius = 1; radius <= CameraRadianceCache::k_search_radius && matches.empty();
         ++radius) {
        for (int j = std::max(0, static_cast<int>(v) - radius);
             j <= std::min(nodes.height() - 1, static_cast<int>(v) + 1 + radius); ++j) {
            for (int i = std::max(0, static_cast<int>(u) - radius);
                 i <= std::min(nodes.width() - 1, static_cast<int>(u) + 1 + radius); ++i) {
                if (!sees(nodes(i, j))) continue;
                const double square = (i - u) * (i - u) + (j - v) * (j - v);
                matches.push_back({&nodes(i, j), 1 / (square * square + 1e-6)});
            }
        }
    }
}

// The surface is too small or too rough for the lattice in the image. Places near by in the world
// serve as well, with the errors of the nodes around; if there are none of either, paths are traced
// for this sample.
void MultipleScattering::estimate_unmatched(const SurfaceSample& sample, SmoothNode& node) const {
    const SurfaceHit& hit = sample.hit;
    std::vector<float>& errors = node.surface_errors.diffuse;
    std::vector<Corner> corners;
    find_corners(sample.x, sample.y, corners);
    for (const Corner& corner : corners) {
        const std::vector<float>& of_corner = corner.node->surface_errors.diffuse;
        if (corner.node->surface && errors.empty()) errors.assign(bands_, 0.0F);
        for (std::size_t b = 0; corner.node->surface && b < of_corner.size(); ++b)
            errors[b] = std::max(errors[b], of_corner[b]);
    }
    const bool is_glossy = hit.has_material && pixels_.scene().surfaces->material(hit).is_glossy;
    if (is_glossy || errors.empty() ||
        !cache_->indirect().covers(hit, k_max_distance_in_cache * hit.distance)) {
        estimator_.estimate_surface(sample, k_paths_of_sample, node.light, node.surface_errors);
        return;
    }
    std::vector<double> diffuse(cache_->indirect().values());
    cache_->indirect().find(hit, diffuse);
    node.light.diffuse.assign(diffuse.begin(), diffuse.end());
}

void MultipleScattering::add_surface(const SurfaceSample& sample, std::span<const double> to_camera,
                                     PixelResult& result, Errors& errors) const {
    std::vector<Corner> matches;
    SmoothNode own;
    find_matches(sample.x, sample.y, sample.hit, matches);
    if (matches.empty()) {
        estimate_unmatched(sample, own);
        matches.push_back({&own, 1});
    }
    double total = 0;
    for (const Corner& match : matches) total += match.weight;
    const SurfaceReflection reflection(*pixels_.scene().surfaces, sample, static_cast<int>(bands_));
    std::vector<double> mirrored, squares;
    const int mirrored_paths = std::max(1, k_mirrored_paths / pixels_.samples());
    if (reflection.is_glossy())
        estimator_.estimate_mirrored(sample, mirrored_paths, mirrored, squares);
    const double weight = 1.0 / pixels_.samples();
    for (std::size_t b = 0; b < bands_; ++b) {
        double error_of_matches = 0;
        for (const Corner& match : matches) {
            const SurfaceErrors& of_node = match.node->surface_errors;
            error_of_matches +=
                match.weight * sample.hit.reflectance[b] * static_cast<double>(of_node.diffuse[b]);
            if (b < of_node.glossy.size())
                error_of_matches += match.weight * static_cast<double>(of_node.glossy[b]);
        }
        errors.surfaces[b] += weight * to_camera[b] * error_of_matches / total;
        if (!reflection.is_glossy()) continue;
        const double of_path = weight * to_camera[b] / mirrored_paths;
        errors.mirrored_squares[b] += of_path * of_path * squares[b];
        for (std::size_t k = b; k < mirrored.size(); k += bands_)
            errors.mirrored[b] += weight * to_camera[b] * mirrored[k];
    }
    if (reflection.is_glossy()) errors.mirrored_paths += mirrored_paths;
    for (std::size_t group = 0; group < cache_->groups(); ++group) {
        for (std::size_t b = 0; b < bands_; ++b) {
            double diffuse = 0, glossy = 0;
            for (const Corner& match : matches) {
                diffuse += match.weight * match.node->light.diffuse[group * bands_ + b];
                if (!match.node->light.glossy.empty())
                    glossy += match.weight * match.node->light.glossy[group * bands_ + b];
            }
            double reflected = sample.hit.reflectance[b] * diffuse / total;
            if (reflection.is_glossy()) reflected += glossy / total + mirrored[group * bands_ + b];
            // The light of nodes comes from a fit, which may be negative in dark places.
            const double radiance = weight * to_camera[b] * std::max(0.0, reflected);
            result.multiple_surface[b] += radiance;
            add_to_lamp(group, b, radiance, result);
        }
    }
}

void MultipleScattering::add(const PixelView& view, const SurfaceLight& light,
                             std::size_t first_sample, PixelResult& result) const {
    if (!view.ray) return;
    Errors errors;
    add_volume(view, result, errors);
    for (std::size_t i = 0; i < view.samples.size(); ++i)
        if (!is_specular(view.samples[i].hit))
            add_surface(view.samples[i], light.to_camera(first_sample + i), result, errors);
    for (std::size_t b = 0; b < bands_; ++b)
        result.error[b] = result.pixel_factor * errors.of_band(b);
}

Spectrum MultipleScattering::light_of_water(const PixelView& view, double distance) const {
    PixelView up_to;
    up_to.x = view.x;
    up_to.y = view.y;
    up_to.distances = {distance};
    up_to.weights = {1};
    std::vector<double> light(cache_->groups() * bands_, 0.0);
    Errors errors;
    add_water(up_to, light, errors);
    Spectrum sum;
    for (std::size_t k = 0; k < light.size(); ++k) sum[k % bands_] += light[k];
    return sum;
}

}  // namespace uw
