#include "core/pixel_renderer.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace uw {

namespace {

// Surface samples whose distances agree this well share one integral through the water: the
// radiance between them differs by less than 1 % of that of the last centimetres.
constexpr double k_same_distance = 0.01;
// Samples on the surface that the pixel's centre sees count as this near: to first order a slanted
// surface's mean is its centre, and the water ray does not reach behind what it meets itself.
constexpr double k_same_surface = 0.25;

// Base-2 radical inverse: 0, 1/2, 1/4, 3/4, ...
double radical_inverse(unsigned i) {
    double result = 0, digit = 0.5;
    for (; i != 0; i >>= 1, digit *= 0.5)
        if ((i & 1) != 0) result += digit;
    return result;
}

struct ImageOffset {
    double x, y;
};

// Hammersley points: every sample has its own row and column of the pixel. One sample: the centre.
ImageOffset sample_offset(int i, int count) {
    const double half_step = 0.5 / count;
    const double y = radical_inverse(static_cast<unsigned>(i)) + half_step;
    return {static_cast<double>(i) / count + half_step, count == 1 ? 0.5 : y};
}

}  // namespace

struct PixelRenderer::Workspace {
    std::vector<double> distances;  // to the surface, of each sample that entered the water
    std::vector<double> ends;
    std::vector<double> shares;  // of the samples that end there; 0 at faces of the first slab
    SurfaceLight light;
    InScatter in_scatter;
    int hits = 0;
    ImageOffset water_at{0.5, 0.5};  // where in the pixel the water's ray passes

    // Makes `ends` and `shares` of the distances; those that agree become one.
    void group(const PixelResult& result, int samples);
    // Makes `distance` one of the ends unless it lies behind them all.
    void add_end(double distance) {
        const auto at = std::lower_bound(ends.begin(), ends.end(), distance);
        if (at == ends.end() || *at == distance) return;
        shares.insert(shares.begin() + (at - ends.begin()), 0.0);
        ends.insert(at, distance);
    }
    // In-scatter by lamp `lamp` up to `distance`, one of the ends, or to end `last` if it is
    // nearer.
    Spectrum in_scatter_up_to(double distance, std::size_t last, std::size_t lamp) const {
        if (distance <= 0) return {};
        const auto at = std::lower_bound(ends.begin(), ends.end(), distance) - ends.begin();
        return in_scatter.at(std::min(last, static_cast<std::size_t>(at)), lamp);
    }
};

void PixelRenderer::Workspace::group(const PixelResult& result, int samples) {
    std::sort(distances.begin(), distances.end());
    ends.clear();
    shares.clear();
    for (std::size_t first = 0; first < distances.size();) {
        std::size_t last = first;
        double sum = 0;
        while (last < distances.size() &&
               distances[last] <= distances[first] * (1 + k_same_distance))
            sum += distances[last++];
        const auto count = static_cast<double>(last - first);
        const bool at_center =
            result.has_hit && distances[first] <= result.path && result.path <= distances[last - 1];
        ends.push_back(at_center ? result.path : sum / count);
        shares.push_back(count / samples);
        first = last;
    }
}

PixelRenderer::PixelRenderer(const RaySource& rays, const LitScene& scene,
                             const Integrator& integrator, int samples, const Slabs& slabs,
                             const SensorModel& sensor)
    : rays_(rays),
      scene_(scene),
      integrator_(integrator),
      samples_(samples),
      slabs_(slabs),
      sensor_(sensor),
      camera_from_world_(rays.world_from_camera().inverse()) {}

void PixelRenderer::render(int x, int y, PixelResult& result) const {
    thread_local Workspace w;
    w.hits = 0;
    std::vector<Spectrum> lamps = std::move(result.lamps);
    result = PixelResult{};
    result.lamps = std::move(lamps);
    result.lamps.assign(scene_.lamps->size(), Spectrum{});

    const std::optional<Ray> water = trace(
        x, y, w, result,
        [&](const Ray& ray, const SurfaceHit& hit) { add_surface_sample(ray, hit, w, result); });
    if (w.hits > 0)
        for (double& t : result.transmittance) t /= w.hits;
    if (water && !w.distances.empty()) {
        w.group(result, samples_);
        add_water(*water, w, result);
    }
    if (water)
        result.pixel_factor =
            sensor_.pixel_factor(rays_.lens_ray(x + w.water_at.x, y + w.water_at.y),
                                 result.has_hit ? result.range : k_infinitely_far);
}

std::optional<Ray> PixelRenderer::trace(int x, int y, Workspace& w, PixelResult& result,
                                        const HitVisitor& on_hit) const {
    w.distances.clear();
    w.water_at = {0.5, 0.5};
    std::optional<Ray> water = rays_.water_ray(x + w.water_at.x, y + w.water_at.y);
    if (water) record_ground_truth(*water, result);
    for (int i = 0; i < samples_; ++i) {
        const ImageOffset offset = sample_offset(i, samples_);
        const std::optional<Ray> ray = rays_.water_ray(x + offset.x, y + offset.y);
        if (!ray) continue;
        if (!water) {
            water = ray;
            w.water_at = offset;
        }
        result.alpha += 1.0 / samples_;
        SurfaceHit hit = result.hit;  // a single sample's ray is that of the ground truth
        if (!(samples_ == 1 ? result.has_hit : scene_.surfaces->closest_hit(*ray, k_far, hit))) {
            w.distances.push_back(k_far);
            continue;
        }
        const bool at_center = result.has_hit && hit.object_id == result.hit.object_id &&
                               std::abs(hit.distance / result.path - 1) < k_same_surface;
        w.distances.push_back(at_center ? result.path : hit.distance);
        on_hit(*ray, hit);
    }
    return water;
}

void PixelRenderer::visit_hits(int x, int y, const HitVisitor& visit) const {
    thread_local Workspace w;
    PixelResult result;
    trace(x, y, w, result, visit);
}

std::optional<Ray> PixelRenderer::water(int x, int y, WaterEnds& ends) const {
    thread_local Workspace w;
    PixelResult result;
    const std::optional<Ray> ray = trace(x, y, w, result, [](const Ray&, const SurfaceHit&) {});
    if (w.distances.empty()) return std::nullopt;
    w.group(result, samples_);
    ends.ends = w.ends;
    ends.shares = w.shares;
    return ray;
}

void PixelRenderer::add_surface_sample(const Ray& ray, const SurfaceHit& hit, Workspace& w,
                                       PixelResult& result) const {
    integrator_.surface_light(ray, hit, w.light);
    ++w.hits;
    const double share = 1.0 / samples_;
    const double seen = sensor_.surface_factor(hit.distance);
    const auto bands = static_cast<std::size_t>(band_count());
    for (std::size_t b = 0; b < bands; ++b) result.transmittance[b] += w.light.transmittance[b];
    for (std::size_t j = 0; j < w.light.lamps.size(); ++j) {
        const LampIrradiance& lamp = w.light.lamps[j];
        if (!lamp.visible) continue;
        result.lit += share / static_cast<double>(w.light.lamps.size());
        for (std::size_t b = 0; b < bands; ++b) {
            const double brdf = hit.reflectance[b] * std::numbers::inv_pi * seen;
            const double direct = share * lamp.irradiance[b] * brdf * w.light.transmittance[b];
            result.irradiance[b] += share * lamp.irradiance[b];
            result.exitance[b] += share * lamp.irradiance[b] * hit.reflectance[b];
            result.clean[b] += share * lamp.clean[b] * brdf;
            result.direct[b] += direct;
            result.lamps[j][b] += direct;
        }
    }
}

void PixelRenderer::add_water(const Ray& ray, Workspace& w, PixelResult& result) const {
    const Interval first = first_slab(ray);
    for (const double face : {first.begin, first.end})
        if (face > 0) w.add_end(face);
    integrator_.in_scatter(ray, w.ends, w.in_scatter);
    for (std::size_t end = 0; end < w.ends.size(); ++end) {
        for (std::size_t j = 0; j < result.lamps.size(); ++j) {
            const Spectrum before = w.in_scatter_up_to(first.begin, end, j);
            const Spectrum behind = w.in_scatter_up_to(first.end, end, j);
            for (std::size_t b = 0; b < static_cast<std::size_t>(band_count()); ++b) {
                const double radiance = w.shares[end] * w.in_scatter.at(end, j)[b];
                result.backscatter[b] += radiance;
                result.lamps[j][b] += radiance;
                result.backscatter_first[b] += w.shares[end] * (behind[b] - before[b]);
            }
        }
    }
}

Interval PixelRenderer::first_slab(const Ray& ray) const {
    const RayDepth depth(camera_from_world_, ray);
    if (depth.cosine() <= 0) return {};
    return {depth.distance(slabs_.boundary(0)), depth.distance(slabs_.boundary(1))};
}

void PixelRenderer::record_ground_truth(const Ray& center, PixelResult& result) const {
    result.has_hit = scene_.surfaces->closest_hit(center, k_far, result.hit);
    if (!result.has_hit) return;
    const Point3 in_camera = camera_from_world_ * result.hit.position;
    result.depth_z = in_camera.z;
    result.range = glm::length(from_origin(in_camera));
    result.path = result.hit.distance;
}

}  // namespace uw
