#include "core/passes/pixel_renderer.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/base/error.h"
#include "core/base/random.h"
#include "core/geometry/surface_reflection.h"
#include "core/geometry/textured_surfaces.h"
#include "core/image/cryptomatte.h"
#include "core/light/ray_transmittance.h"
#include "core/light/submerged.h"

namespace uw {

namespace {

// Differs from the seeds of light paths.
constexpr std::uint64_t k_sampling_seed = 0x61706572;

// Radical inverse: for base 2, 0, 1/2, 1/4, 3/4, ...
template <unsigned base>
double radical_inverse(int number) {
    double result = 0, digit = 1.0 / base;
    for (auto i = static_cast<unsigned>(number); i != 0; i /= base, digit /= base)
        result += digit * (i % base);
    return result;
}

}  // namespace

PixelSampling::PixelSampling(const PixelSamples& samples, int x, int y) : samples_(samples) {
    const auto pixel = static_cast<std::uint64_t>(y) << 32U | static_cast<std::uint64_t>(x);
    PathRandom random(PathRandom::seed_of(k_sampling_seed, pixel), 0);
    shift_a_ = random.next();
    shift_b_ = random.next();
    shift_moment_ = random.next();
}

ImageOffset PixelSampling::offset(int i) const {
    if (samples_.total > 0) {
        const double half_step = 0.5 / samples_.total;
        const int number = samples_.first + i;
        return {radical_inverse<2>(number) + half_step, radical_inverse<3>(number) + half_step};
    }
    if (samples_.count == 1) return {0.5, 0.5};
    const double half_step = 0.5 / samples_.count;
    return {static_cast<double>(i) / samples_.count + half_step, radical_inverse<2>(i) + half_step};
}

AperturePoint PixelSampling::aperture(int i) const {
    const bool is_part = samples_.total > 0;
    const int number = samples_.first + i;
    const double a = (is_part ? radical_inverse<5>(number) : radical_inverse<3>(number)) + shift_a_;
    const double b = (is_part ? radical_inverse<7>(number) : radical_inverse<5>(number)) + shift_b_;
    return aperture_point(std::fmod(a, 1.0), std::fmod(b, 1.0));
}

void find_matches(const PointMatchers& matchers, std::span<PixelView> views) {
    if (!matchers.next && !matchers.previous && !matchers.other_camera) return;
    std::vector<const SurfaceHit*> hits;
    // The mirror image that the water's surface shows is not at a point of that surface.
    const auto has_point = [](const PixelView& view) {
        return view.has_hit && !view.hit.is_water_surface;
    };
    for (const PixelView& view : views)
        if (has_point(view)) hits.push_back(&view.hit);
    std::vector<std::optional<PointMatch>> matches(hits.size());
    const auto look = [&](const PointMatcher* matcher,
                          std::optional<PointMatch> PointMatches::*which) {
        if (!matcher) return;
        matcher->match(hits, matches);
        auto match = matches.begin();
        for (PixelView& view : views)
            if (has_point(view)) view.matches.*which = *match++;
    };
    look(matchers.next, &PointMatches::next);
    look(matchers.previous, &PointMatches::previous);
    look(matchers.other_camera, &PointMatches::other_camera);
}

void store_matches(const PointMatchers& matchers, const PixelView& view, PixelResult& result) {
    const auto store = [&](const PointMatcher* matcher, const std::optional<PointMatch>& match,
                           double sign, std::array<double, 2>& offset, double* occluded) {
        if (!matcher || !match) return;
        offset = {sign * (match->x - view.x), sign * (match->y - view.y)};
        if (occluded) *occluded = match->is_occluded ? 1 : 0;
    };
    store(matchers.next, view.matches.next, 1, result.flow, &result.flow_occluded);
    store(matchers.previous, view.matches.previous, 1, result.flow_back, nullptr);
    store(matchers.other_camera, view.matches.other_camera, matchers.is_first_camera ? -1 : 1,
          result.disparity, &result.disparity_occluded);
}

namespace {

// Returns the Cryptomatte identifier of each id; 0 is no surface.
std::vector<float> matte_ids(const std::vector<SurfaceName>& names) {
    std::vector<float> ids{0.0F};
    for (const SurfaceName& name : names) ids.push_back(matte_id(name.name));
    return ids;
}

// Surface samples whose distances agree to within this fraction share one in-scattering integral:
// it differs between them by less than 1 % of that of the last centimetres.
constexpr double k_same_distance = 0.01;
// Samples on the object at the pixel's centre get the centre's distance if theirs agrees with it to
// within this fraction: the mean over a slanted surface is, to first order, its centre, and the ray
// through the water does not continue behind the surface that it hits.
constexpr double k_same_surface = 0.25;

// Merges those of the view's distances that agree, one per sample so far, and sets the weights.
void group_distances(int samples, PixelView& view) {
    std::vector<double>& distances = view.distances;
    std::size_t groups = 0;
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
        distances[groups++] = at_center ? view.path : sum / count;
        view.weights.push_back(count / samples);
        first = last;
    }
    distances.resize(groups);
}

}  // namespace

PixelRenderer::PixelRenderer(const RaySource& rays, const LitScene& scene,
                             const LightTransport& transport, const PixelSamples& samples,
                             const Slabs& slabs, const SensorModel& sensor,
                             const InScatterParts& parts, const PointMatchers& matchers)
    : rays_(rays),
      scene_(scene),
      transport_(transport),
      samples_(samples),
      sensor_(sensor),
      in_scatter_(*transport.integrator, rays.world_from_camera(), slabs, lamp_count(),
                  band_count(), parts),
      lamps_in_view_(scene),
      textures_(textures_of(*scene.surfaces)),
      matchers_(matchers),
      object_mattes_(matte_ids(scene.surfaces->names().objects)),
      material_mattes_(matte_ids(scene.surfaces->names().materials)),
      camera_from_world_(rays.world_from_camera().inverse()) {
    for (const auto& part : transport.parts)
        parts_.emplace_back(*part, rays.world_from_camera(), slabs, lamp_count(), band_count(),
                            parts);
}

void PixelRenderer::trace(int x, int y, PixelView& view) const {
    trace_center(x, y, view);
    add_samples(x, y, view);
}

void PixelRenderer::trace_center(int x, int y, PixelView& view) const {
    begin_view(x, y, view);
    view.has_hit = view.ray && scene_.surfaces->closest_hit(*view.ray, k_far, view.hit);
    finish_ground_truth(view);
    find_matches(matchers_, std::span(&view, 1));
}

void PixelRenderer::trace(const PixelWindow& window, Grid2D<PixelView>& views) const {
    std::vector<Ray> rays;
    std::vector<SurfaceHit> hits;
    std::vector<char> found;
    views.resize(window.width(), window.height());
    for (int y = window.y0; y < window.y1; ++y) {
        const std::span<PixelView> row = views.row(y - window.y0);
        rays.clear();
        for (std::size_t i = 0; i < row.size(); ++i) {
            begin_view(window.x0 + static_cast<int>(i), y, row[i]);
            if (row[i].ray) rays.push_back(*row[i].ray);
        }
        hits.resize(rays.size());
        found.resize(rays.size());
        scene_.surfaces->closest_hits(rays, k_far, hits, found);
        std::size_t next = 0;
        for (std::size_t i = 0; i < row.size(); ++i) {
            PixelView& view = row[i];
            if (view.ray) {
                view.has_hit = found[next] != 0;
                if (view.has_hit) view.hit = hits[next];
                ++next;
            }
            finish_ground_truth(view);
            add_samples(window.x0 + static_cast<int>(i), y, view);
        }
        find_matches(matchers_, row);
    }
}

void PixelRenderer::begin_view(int x, int y, PixelView& view) const {
    view.alpha = 0;
    view.distances.clear();
    view.weights.clear();
    view.samples.clear();
    view.lamps.clear();
    view.x = x + 0.5;
    view.y = y + 0.5;
    view.is_central = true;
    view.has_hit = false;
    view.ray = rays_.refracted_ray(view.x, view.y);
}

namespace {

/// The footprint on surfaces of one of the `count` samples of a pixel, over which textures are
/// filtered. `textures` is null if there are none.
class SampleSpread {
  public:
    SampleSpread(const RaySource& rays, const TexturedSurfaces* textures, const PixelView& view,
                 int count)
        : rays_(rays), textures_(view.ray ? textures : nullptr), x_(view.x), y_(view.y) {
        if (textures_ == nullptr) return;
        center_ = *view.ray;
        // A footprint is wider than an equal part of the pixel, since samples do not lie on a
        // regular grid.
        constexpr double k_overlap = 1.5;
        if (count > 1) width_ = std::min(1.0, k_overlap / std::sqrt(static_cast<double>(count)));
    }

    /// Filters the textures at a hit over the footprint. It follows from the pixel's own ray, near
    /// which the rays of all samples pass, whatever their points of the aperture.
    void filter_textures(SurfaceHit& hit) {
        if (textures_ == nullptr || !textures_->is_textured(hit)) return;
        if (!std::exchange(has_neighbours_, true)) {
            right_ = rays_.refracted_ray(x_ + 1, y_);
            below_ = rays_.refracted_ray(x_, y_ + 1);
        }
        textures_->filter_textures({step_on(hit, right_), step_on(hit, below_)}, hit);
    }

  private:
    /// Returns the vector from the intersection of the pixel's ray with the plane of a hit to that
    /// of the ray `neighbour`; zero if one of them misses the plane.
    Vector3 step_on(const SurfaceHit& hit, const std::optional<Ray>& neighbour) const {
        const auto meet = [&](const Ray& ray) -> std::optional<Point3> {
            const double slope = glm::dot(ray.direction, hit.geometric_normal);
            const double s = glm::dot(hit.position - ray.origin, hit.geometric_normal) / slope;
            if (!(s > 0) || !std::isfinite(s)) return std::nullopt;
            return ray.at(s);
        };
        if (!neighbour) return Vector3(0.0);
        const auto here = meet(center_), there = meet(*neighbour);
        return here && there ? width_ * (*there - *here) : Vector3(0.0);
    }

    const RaySource& rays_;
    const TexturedSurfaces* textures_;
    double x_, y_;  // of the pixel's ray
    Ray center_;
    bool has_neighbours_ = false;       // whether right_ and below_ are set
    std::optional<Ray> right_, below_;  // one pixel further to the right and below
    double width_ = 1;                  // of the footprint [pixels]
};

}  // namespace

// A single sample has the ray of the ground truth, but its textures are filtered.
void PixelRenderer::add_center(PixelView& view) const {
    if (!view.ray) return;
    view.alpha = 1;
    view.distances.push_back(view.has_hit ? view.path : k_far);
    view.weights.push_back(1);
    if (view.has_hit) {
        view.samples.push_back({*view.ray, view.hit, view.x, view.y});
        SampleSpread(rays_, textures_, view, 1).filter_textures(view.samples.back().hit);
    }
    lamps_in_view_.append(*view.ray, view.distances.back(), view.lamps);
}

void PixelRenderer::add_samples(int x, int y, PixelView& view) const {
    const int count = samples_.count;
    if (count == 1 && samples_.total == 0) {
        add_center(view);
        return;
    }
    const bool has_aperture = rays_.has_aperture();
    const bool differ = has_aperture || rays_.moves();
    const PixelSampling sampling(samples_, x, y);
    SampleSpread spread(rays_, textures_, view, std::max(count, samples_.total));
    for (int i = 0; i < count; ++i) {
        throw_if_stopped();
        const ImageOffset offset = sampling.offset(i);
        const AperturePoint point = has_aperture ? sampling.aperture(i) : AperturePoint{};
        const std::optional<Ray> ray =
            differ ? rays_.aperture_ray(x + offset.x, y + offset.y, point, sampling.moment(i))
                   : rays_.refracted_ray(x + offset.x, y + offset.y);
        if (!ray) continue;
        if (!view.ray) {
            view.ray = ray;
            view.x = x + offset.x;
            view.y = y + offset.y;
            view.is_central = false;
        }
        view.alpha += 1.0 / count;
        SurfaceSample& sample = view.samples.emplace_back();
        sample.ray = *ray;
        sample.x = x + offset.x;
        sample.y = y + offset.y;
        if (!scene_.surfaces->closest_hit(*ray, k_far, sample.hit)) {
            view.samples.pop_back();
            view.distances.push_back(k_far);
            lamps_in_view_.append(*ray, k_far, view.lamps);
            continue;
        }
        spread.filter_textures(sample.hit);
        lamps_in_view_.append(*ray, sample.hit.distance, view.lamps);
        const bool at_center = view.has_hit && sample.hit.object_id == view.hit.object_id &&
                               std::abs(sample.hit.distance / view.path - 1) < k_same_surface;
        view.distances.push_back(at_center ? view.path : sample.hit.distance);
    }
    group_distances(count, view);
}

void PixelRenderer::light_surfaces(std::span<const PixelView> views, SurfaceLight& light) const {
    std::vector<const SurfaceSample*> samples;
    for (const PixelView& view : views)
        for (const SurfaceSample& sample : view.samples) samples.push_back(&sample);
    transport_.surfaces->evaluate(samples, light);
}

void PixelRenderer::shade(const PixelView& view, const SurfaceLight& light,
                          std::size_t first_sample, std::span<const double> in_scatter,
                          PixelResult& result) const {
    const auto bands = static_cast<std::size_t>(band_count());
    result.reset(in_scatter_.parts().lamps ? scene_.lamp_count() : 0, bands);
    result.alpha = view.alpha;
    store_truth(view, result);
    for (std::size_t i = 0; i < view.samples.size(); ++i) {
        throw_if_stopped();
        add_surface(view.samples[i], light, first_sample + i, result);
    }
    if (!view.samples.empty())
        for (double& transmittance : result.transmittance.first(bands))
            transmittance /= static_cast<double>(view.samples.size());
    for (const SeenLamp& lamp : view.lamps) add_lamp(lamp, result);
    add_mattes(view, result);
    if (!view.ray) return;
    add_water(in_scatter, result);
    result.pixel_factor = pixel_factor(view);
}

void PixelRenderer::store_truth(const PixelView& view, PixelResult& result) const {
    result.has_hit = view.has_hit;
    if (plume_ && view.ray && view.is_central) store_plume(view, result);
    if (!view.has_hit) return;
    result.hit = view.hit;
    result.depth_z = view.depth_z;
    result.range = view.range;
    result.path = view.path;
    store_matches(matchers_, view, result);
}

void PixelRenderer::find_truth(int x, int y, PixelResult& result) const {
    PixelView view;
    result.reset(0);
    trace_center(x, y, view);
    store_truth(view, result);
}

double PixelRenderer::pixel_factor(const PixelView& view) const {
    if (!view.ray || !(sensor_.uses_lens() || rays_.port_dims())) return 1;
    const double focus = rays_.has_aperture() ? 1 / rays_.focus_vergence()
                         : view.has_hit       ? view.range
                                              : k_infinitely_far;
    return sensor_.pixel_factor(rays_.lens_ray(view.x, view.y), focus);
}

void PixelRenderer::render(int x, int y, PixelResult& result) const {
    PixelView view;
    SurfaceLight surfaces;
    trace(x, y, view);
    std::vector<double> in_scatter(in_scatter_.value_count());
    in_scatter_.integrate(view, in_scatter);
    light_surfaces(std::span(&view, 1), surfaces);
    shade(view, surfaces, 0, in_scatter, result);
}

void PixelRenderer::add_surface(const SurfaceSample& surface, const SurfaceLight& light,
                                std::size_t sample, PixelResult& result) const {
    const SurfaceHit& hit = surface.hit;
    const double weight = 1.0 / samples_.count;
    const double factor = sensor_.surface_factor(hit.distance);
    const auto bands = static_cast<std::size_t>(band_count());
    const std::span<const double> to_camera = light.to_camera(sample);
    const SurfaceReflection reflection(*scene_.surfaces, surface, band_count());
    add(result.transmittance.first(bands), to_camera);
    if (reflection.emits()) {
        const auto sky =
            result.lamps.empty() ? std::nullopt : lamp_of_emission(*scene_.surfaces, hit);
        for (std::size_t b = 0; b < bands; ++b) {
            const double emission = weight * reflection.emission()[b] * factor;
            result.clean[b] += emission;
            result.direct[b] += emission * to_camera[b];
            if (sky) result.lamps[*sky][b] += emission * to_camera[b];
        }
    }
    Spectrum brdf;
    for (std::size_t j = 0; j < light.emitter_count(); ++j) {
        if (!light.visible(sample, j)) continue;
        const Lamp& emitter = light.emitters()[j];
        if (!emitter.is_mirrored())
            result.lit += weight * light.visibility(sample, j) * emitter.fraction() /
                          static_cast<double>(lamp_count());
        brdf_for(emitter, reflection, surface, brdf);
        // A single loop is faster than a spectrum per product: it runs for every sample and every
        // emitter.
        for (std::size_t b = 0; b < bands; ++b) {
            const double irradiance = weight * light.irradiance(sample, j, b);
            const double response = brdf[b] * factor;
            const double direct = irradiance * response * to_camera[b];
            result.irradiance[b] += irradiance;
            result.exitance[b] += irradiance * hit.reflectance[b];
            result.clean[b] += weight * light.clean(sample, j, b) * response;
            result.direct[b] += direct;
            if (!result.lamps.empty()) result.lamps[emitter.index()][b] += direct;
        }
    }
}

void PixelRenderer::add_mattes(const PixelView& view, PixelResult& result) const {
    const auto id_of = [](const std::vector<float>& ids, std::uint32_t number) {
        return number < ids.size() ? ids[number] : 0.0F;
    };
    for (const SurfaceSample& sample : view.samples)
        result.visible_surfaces.push_back({id_of(object_mattes_, sample.hit.object_id),
                                           id_of(material_mattes_, sample.hit.material_id),
                                           1.0 / samples_.count});
}

void PixelRenderer::add_lamp(const SeenLamp& lamp, PixelResult& result) const {
    const double weight = sensor_.surface_factor(lamp.distance) / samples_.count;
    for (std::size_t b = 0; b < static_cast<std::size_t>(band_count()); ++b) {
        const double arriving = weight * lamp.arriving[b];
        result.clean[b] += weight * lamp.radiance[b];
        result.direct[b] += arriving;
        result.lamps_in_view[b] += arriving;
        if (!result.lamps.empty()) result.lamps[lamp.lamp][b] += arriving;
    }
    if (!lamp.is_volume) result.shows_lamp = true;
}

void PixelRenderer::add_water(std::span<const double> in_scatter, PixelResult& result) const {
    for (std::size_t group = 0; group < in_scatter_.group_count(); ++group) {
        const std::span<const double> values = in_scatter_.group(in_scatter, group);
        add(result.backscatter.first(values.size()), values);
        if (!result.lamps.empty()) add(result.lamps[group].first(values.size()), values);
    }
    if (!in_scatter_.parts().first_slab) return;
    // The first slab is a difference of rounded and interpolated sums, which may be negative.
    std::ranges::transform(in_scatter_.first_slab(in_scatter), result.backscatter_first.begin(),
                           [](double value) { return std::max(0.0, value); });
}

void PixelRenderer::finish_ground_truth(PixelView& view) const {
    if (!view.has_hit) return;
    const Point3 point = in_camera(view, view.hit.position);
    view.depth_z = point.z;
    view.range = glm::length(from_origin(point));
    view.path = view.hit.distance;
}

Point3 PixelRenderer::in_camera(const PixelView& view, const Point3& point) const {
    return rays_.is_rolling() ? rays_.world_from_camera_at(view.y).inverse() * point
                              : camera_from_world_ * point;
}

void PixelRenderer::find_plume() {
    plume_ = attenuation_of_constituents(*scene_.medium);
}

void PixelRenderer::store_plume(const PixelView& view, PixelResult& result) const {
    const RayTransmittance through(*plume_, scene_.field->grids(), *view.ray,
                                   view.has_hit ? view.path : k_far);
    result.plume_optical_depth = through.optical_depth(through.end());
    const double seen_through = through.mean_transmittance(through.end());
    result.plume_opacity = 1 - seen_through;
    const auto range_at = [&](double transmittance) {
        const std::optional<double> s = through.distance_at(transmittance);
        return s ? glm::length(from_origin(in_camera(view, view.ray->at(*s)))) : 0;
    };
    result.plume_range_50 = range_at(0.5);
    result.plume_range_10 = range_at(0.1);
    if (!matchers_.plume || !(result.plume_opacity > 0)) return;
    const std::optional<double> middle = through.distance_at(1 - 0.5 * result.plume_opacity);
    const auto match = middle ? matchers_.plume->match(view.ray->at(*middle)) : std::nullopt;
    if (match) result.plume_flow = {match->x - view.x, match->y - view.y};
}

}  // namespace uw
