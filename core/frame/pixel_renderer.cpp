#include "core/frame/pixel_renderer.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/surfaces/surface_reflection.h"

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

constexpr std::array k_parts{&PixelResult::direct,       &PixelResult::backscatter,
                             &PixelResult::irradiance,   &PixelResult::backscatter_first,
                             &PixelResult::exitance,     &PixelResult::clean,
                             &PixelResult::transmittance};

// Makes ends and shares of the samples' distances; those that agree become one.
void group_ends(std::vector<double>& distances, int samples, PixelView& view) {
    std::sort(distances.begin(), distances.end());
    for (std::size_t first = 0; first < distances.size();) {
        std::size_t last = first;
        double sum = 0;
        while (last < distances.size() &&
               distances[last] <= distances[first] * (1 + k_same_distance))
            sum += distances[last++];
        const auto count = static_cast<double>(last - first);
        const bool at_center =
            view.has_hit && distances[first] <= view.path && view.path <= distances[last - 1];
        view.ends.push_back(at_center ? view.path : sum / count);
        view.shares.push_back(count / samples);
        first = last;
    }
}

}  // namespace

PixelRenderer::PixelRenderer(const RaySource& rays, const LitScene& scene,
                             const Integrator& integrator, int samples, const Slabs& slabs,
                             const SensorModel& sensor, const InScatterParts& parts)
    : rays_(rays),
      scene_(scene),
      integrator_(integrator),
      samples_(samples),
      sensor_(sensor),
      water_(integrator, rays.world_from_camera(), slabs, lamp_count(), band_count(), parts),
      camera_from_world_(rays.world_from_camera().inverse()) {}

void PixelRenderer::look(int x, int y, PixelView& view) const {
    begin_view(x, y, view);
    view.has_hit = view.ray && scene_.surfaces->closest_hit(*view.ray, k_far, view.hit);
    finish_ground_truth(view);
    add_samples(x, y, view);
}

void PixelRenderer::look(const PixelWindow& window, std::span<PixelView> views) const {
    thread_local std::vector<Ray> rays;
    thread_local std::vector<SurfaceHit> hits;
    thread_local std::vector<char> found;
    const auto width = static_cast<std::size_t>(window.width());
    for (int y = window.y0; y < window.y1; ++y) {
        const std::span row = views.subspan(static_cast<std::size_t>(y - window.y0) * width, width);
        rays.clear();
        for (std::size_t i = 0; i < width; ++i) {
            begin_view(window.x0 + static_cast<int>(i), y, row[i]);
            if (row[i].ray) rays.push_back(*row[i].ray);
        }
        hits.resize(rays.size());
        found.resize(rays.size());
        scene_.surfaces->closest_hits(rays, k_far, hits, found);
        std::size_t next = 0;
        for (std::size_t i = 0; i < width; ++i) {
            PixelView& view = row[i];
            if (view.ray) {
                view.has_hit = found[next] != 0;
                if (view.has_hit) view.hit = hits[next];
                ++next;
            }
            finish_ground_truth(view);
            add_samples(window.x0 + static_cast<int>(i), y, view);
        }
    }
}

void PixelRenderer::begin_view(int x, int y, PixelView& view) const {
    view.alpha = 0;
    view.ends.clear();
    view.shares.clear();
    view.samples.clear();
    view.x = x + 0.5;
    view.y = y + 0.5;
    view.has_hit = false;
    view.ray = rays_.refracted_ray(view.x, view.y);
}

// A single sample's ray is that of the ground truth.
void PixelRenderer::add_center(PixelView& view) {
    if (!view.ray) return;
    view.alpha = 1;
    view.ends.push_back(view.has_hit ? view.path : k_far);
    view.shares.push_back(1);
    if (view.has_hit) view.samples.push_back({*view.ray, view.hit, view.x, view.y});
}

void PixelRenderer::add_samples(int x, int y, PixelView& view) const {
    thread_local std::vector<double> distances;
    distances.clear();
    if (samples_ == 1) {
        add_center(view);
        return;
    }
    for (int i = 0; i < samples_; ++i) {
        const ImageOffset offset = sample_offset(i, samples_);
        const std::optional<Ray> ray = rays_.refracted_ray(x + offset.x, y + offset.y);
        if (!ray) continue;
        if (!view.ray) {
            view.ray = ray;
            view.x = x + offset.x;
            view.y = y + offset.y;
        }
        view.alpha += 1.0 / samples_;
        SurfaceSample& sample = view.samples.emplace_back();
        sample.ray = *ray;
        sample.x = x + offset.x;
        sample.y = y + offset.y;
        if (!scene_.surfaces->closest_hit(*ray, k_far, sample.hit)) {
            view.samples.pop_back();
            distances.push_back(k_far);
            continue;
        }
        const bool at_center = view.has_hit && sample.hit.object_id == view.hit.object_id &&
                               std::abs(sample.hit.distance / view.path - 1) < k_same_surface;
        distances.push_back(at_center ? view.path : sample.hit.distance);
    }
    group_ends(distances, samples_, view);
}

void PixelRenderer::light_surfaces(std::span<const PixelView> views, SurfaceLight& light) const {
    thread_local std::vector<const SurfaceSample*> samples;
    samples.clear();
    for (const PixelView& view : views)
        for (const SurfaceSample& sample : view.samples) samples.push_back(&sample);
    integrator_.surface_lights(samples, light);
}

void PixelRenderer::shade(const PixelView& view, const SurfaceLight& light,
                          std::size_t first_sample, std::span<const double> water,
                          PixelResult& result) const {
    const auto bands = static_cast<std::size_t>(band_count());
    for (Spectrum PixelResult::*part : k_parts) std::fill_n((result.*part).begin(), bands, 0.0);
    result.lamps.assign(water_.parts().lamps ? scene_.lamps->size() : 0, Spectrum{});
    result.lit = 0;
    result.pixel_factor = 1;
    result.alpha = view.alpha;
    result.has_hit = view.has_hit;
    if (view.has_hit)
        result.hit = view.hit;
    else
        result.hit = {};
    result.depth_z = view.has_hit ? view.depth_z : 0;
    result.range = view.has_hit ? view.range : 0;
    result.path = view.has_hit ? view.path : 0;
    for (std::size_t i = 0; i < view.samples.size(); ++i)
        add_surface(view.samples[i], light, first_sample + i, result);
    if (!view.samples.empty())
        for (std::size_t b = 0; b < bands; ++b)
            result.transmittance[b] /= static_cast<double>(view.samples.size());
    if (!view.ray) return;
    add_water(water, result);
    if (sensor_.uses_lens() || rays_.port_dims())
        result.pixel_factor = sensor_.pixel_factor(rays_.lens_ray(view.x, view.y),
                                                   view.has_hit ? view.range : k_infinitely_far);
}

void PixelRenderer::render(int x, int y, PixelResult& result) const {
    thread_local PixelView view;
    thread_local std::vector<double> row;
    thread_local SurfaceLight surfaces;
    look(x, y, view);
    row.resize(water_.row_size());
    water_.gather(view, row);
    light_surfaces(std::span(&view, 1), surfaces);
    shade(view, surfaces, 0, row, result);
}

void PixelRenderer::add_surface(const SurfaceSample& surface, const SurfaceLight& light,
                                std::size_t sample, PixelResult& result) const {
    const SurfaceHit& hit = surface.hit;
    const double share = 1.0 / samples_;
    const double seen = sensor_.surface_factor(hit.distance);
    const auto bands = static_cast<std::size_t>(band_count());
    const std::span<const double> to_camera = light.to_camera(sample);
    const SurfaceReflection reflection(*scene_.surfaces, surface, band_count());
    for (std::size_t b = 0; b < bands; ++b) result.transmittance[b] += to_camera[b];
    if (reflection.emits()) {
        for (std::size_t b = 0; b < bands; ++b) {
            const double emission = share * reflection.emission()[b] * seen;
            result.clean[b] += emission;
            result.direct[b] += emission * to_camera[b];
        }
    }
    Spectrum brdf{};
    for (std::size_t j = 0; j < light.lamp_count(); ++j) {
        if (!light.visible(sample, j)) continue;
        result.lit += share / static_cast<double>(light.lamp_count());
        reflection.brdf((*scene_.lamps)[j].position(), brdf);
        for (std::size_t b = 0; b < bands; ++b) {
            const double irradiance = share * light.irradiance(sample, j, b);
            const double response = brdf[b] * seen;
            const double direct = irradiance * response * to_camera[b];
            result.irradiance[b] += irradiance;
            result.exitance[b] += irradiance * hit.reflectance[b];
            result.clean[b] += share * light.clean(sample, j, b) * response;
            result.direct[b] += direct;
            if (!result.lamps.empty()) result.lamps[j][b] += direct;
        }
    }
}

void PixelRenderer::add_water(std::span<const double> row, PixelResult& result) const {
    for (std::size_t group = 0; group < water_.group_count(); ++group) {
        const std::span<const double> in = water_.group(row, group);
        for (std::size_t b = 0; b < in.size(); ++b) {
            result.backscatter[b] += in[b];
            if (!result.lamps.empty()) result.lamps[group][b] += in[b];
        }
    }
    if (!water_.parts().first_slab) return;
    const std::span<const double> first = water_.first_slab(row);
    std::copy(first.begin(), first.end(), result.backscatter_first.begin());
}

void PixelRenderer::finish_ground_truth(PixelView& view) const {
    if (!view.has_hit) return;
    const Point3 in_camera = camera_from_world_ * view.hit.position;
    view.depth_z = in_camera.z;
    view.range = glm::length(from_origin(in_camera));
    view.path = view.hit.distance;
}

}  // namespace uw
