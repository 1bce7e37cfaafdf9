#include "core/passes/path_pass.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>

#include "core/base/available_memory.h"
#include "core/base/error.h"
#include "core/base/grid2d.h"
#include "core/base/parallel.h"
#include "core/geometry/glass.h"
#include "core/geometry/surface_reflection.h"
#include "core/light/integrator_table.h"
#include "core/passes/pixel_terms.h"
#include "core/paths/path_tracer.h"
#include "core/scene/render_desc.h"

namespace uw {

namespace {

// Number of rays of a batch that are traced and lit together.
constexpr int k_rays_at_once = 64;

// Each estimate of a path has its own stream of random numbers, whose dimensions follow those of
// the image position.
enum Stream : std::uint64_t { k_position, k_single, k_water, k_surface, k_lit, k_glass };
constexpr int k_position_dimensions = 2;
// The aperture's dimensions lie beyond those of the rank-1 lattice, which the estimates use.
constexpr int k_aperture_dimension = 64;

// Behind glass, the streams of each further leg begin at another multiple of this.
constexpr std::uint64_t k_streams = 16;

/// Options of the legs that a camera ray's path has behind glass.
struct GlassLegOptions {
    /// The surfaces of glass that a path meets.
    int max_surfaces = 64;
    /// Below this weight it goes on by Russian roulette, in proportion to the weight.
    double min_weight = 0.1;
};
constexpr GlassLegOptions k_glass_leg_options;

// Parts of an exposure number their batches from first_sample << k_part_shift on, so that no two of
// them have the same random numbers.
constexpr unsigned k_part_shift = 24;

// Samples a ray through a random point of the aperture, if there is one, at a random time.
std::optional<Ray> camera_ray(const RaySource& rays, double x, double y, PathRandom& random) {
    if (!rays.has_aperture() && !rays.moves()) return rays.refracted_ray(x, y);
    random.skip_to(k_aperture_dimension);
    const double a = random.next(), b = random.next();
    return rays.aperture_ray(x, y, rays.has_aperture() ? aperture_point(a, b) : AperturePoint{},
                             random.next());
}

}  // namespace

namespace {

/// A kind of light path: its count, its random numbers, the part of the pixel's light that it
/// estimates, and how it is traced.
struct Kind {
    double PathCounts::*count;
    Stream stream;
    Spectrum PixelResult::*part;
    double (*trace)(const PathTracer&, CameraSegment&, PathRandom&, ContributionSink&);
};

constexpr std::array k_kinds{
    Kind{&PathCounts::water, k_water, &PixelResult::multiple_volume,
         [](const PathTracer& paths, CameraSegment& segment, PathRandom& random,
            ContributionSink& sink) { return paths.trace_water(segment, random, sink); }},
    Kind{&PathCounts::lit, k_lit, &PixelResult::multiple_volume,
         [](const PathTracer& paths, CameraSegment& segment, PathRandom& random,
            ContributionSink& sink) { return paths.trace_lit_surfaces(segment, random, sink); }},
    Kind{&PathCounts::surface, k_surface, &PixelResult::multiple_surface,
         [](const PathTracer& paths, CameraSegment& segment, PathRandom& random,
            ContributionSink& sink) { return paths.trace_surface(segment, random, sink); }}};

}  // namespace

/// One batch of paths of a pixel.
struct PathPixels::Batch {
    std::uint64_t pixel, number;
    int samples;
    std::uint64_t leg = 0;  // behind glass, from 1

    PathRandom random(Stream stream, int index) const {
        PathRandom numbers(PathRandom::seed_of(pixel, number, stream + leg * k_streams),
                           static_cast<std::uint32_t>(index));
        if (stream != k_position) numbers.skip_to(k_position_dimensions);
        return numbers;
    }
};

/// Memory in which one pixel is rendered.
struct PathPixels::Scratch {
    PixelView view;
    // These are of the rays that are traced at once:
    std::vector<Ray> rays;
    std::vector<int> indices;  // of the rays' paths
    std::vector<SurfaceHit> hits;
    std::vector<char> found;
    std::vector<SurfaceSample> samples;
    std::vector<const SurfaceSample*> surfaces;
    SurfaceLight light;
    // These are of one of them:
    std::vector<SeenLamp> lamps;
    CameraSegment segment;
    SurfaceLight light_behind;  // of a leg behind glass
};

/// Adds contributions to the pixel and to the sum of the current batch.
class PathPixels::Sum final : public ContributionSink {
  public:
    Sum(PixelResult& pixel, std::size_t bands, ContributionSink* observer = nullptr)
        : pixel_(pixel), bands_(bands), observer_(observer) {}

    std::size_t bands() const { return bands_; }
    /// Sets the part of the pixel's light to which the next contributions belong.
    void set_part(Spectrum PixelResult::*part) { part_ = part; }
    /// Sets the first slab: light that the water scatters there is added to backscatter_first, too.
    void set_first_slab(const Interval& slab) { first_slab_ = slab; }
    /// Sets the factor, by band, on the next contributions.
    void set_weight(const Spectrum& weight) { weight_ = weight; }
    void reset_weight() { weight_.reset(); }
    /// Adds to the pixel's alpha, which counts the rays.
    void add_rays(std::size_t count) { pixel_.alpha += static_cast<double>(count); }

    void begin_batch() { batch_ = {}; }
    /// The sum of all contributions since begin_batch.
    const Spectrum& batch() const { return batch_; }

    int add_vertex(int before, const PathVertex& vertex) override {
        return observer_ != nullptr ? observer_->add_vertex(before, vertex) : k_no_vertex;
    }
    void add(const PathContribution& arriving) override {
        PathContribution contribution = arriving;
        Spectrum weighted;
        if (weight_) {
            for (std::size_t b = 0; b < bands_; ++b)
                weighted[b] = (*weight_)[b] * arriving.radiance[b];
            contribution.radiance = weighted.first(bands_);
        }
        if (observer_ != nullptr) observer_->add(contribution);
        add_to(pixel_.*part_, contribution);
        add_to(batch_, contribution);
        if (part_ == &PixelResult::backscatter && contribution.distance >= first_slab_.begin &&
            contribution.distance < first_slab_.end)
            add_to(pixel_.backscatter_first, contribution);
        if (contribution.lamp != k_no_lamp && !pixel_.lamps.empty())
            add_to(pixel_.lamps[contribution.lamp], contribution);
        if (pixel_.orders.empty()) return;
        const auto last = static_cast<int>(pixel_.orders.size()) - 1;
        add_to(pixel_.orders[static_cast<std::size_t>(std::min(contribution.scatterings, last))],
               contribution);
        add_to(
            pixel_.reflections[static_cast<std::size_t>(std::min(contribution.reflections, last))],
            contribution);
    }

  private:
    void add_to(Spectrum& sum, const PathContribution& contribution) const {
        uw::add(sum.first(bands_), contribution.radiance);
    }

    PixelResult& pixel_;
    std::size_t bands_;
    ContributionSink* observer_;
    Spectrum PixelResult::*part_ = &PixelResult::direct;
    Interval first_slab_{};
    std::optional<Spectrum> weight_;  // none: 1
    Spectrum batch_;
};

void PathPixels::render(int x, int y, const PathRound& round, const TracedCallback& traced,
                        PixelResult& result, ContributionSink* observer) const {
    Scratch scratch;
    PixelView& view = scratch.view;
    render_without_paths(x, y, round, view, result);
    const auto bands = static_cast<std::size_t>(pixels_.band_count());
    const bool has_ray = view.ray.has_value();
    Sum sum(result, bands, observer);
    std::array<Spectrum, PathRound::k_batches> means;
    std::array<int, PathRound::k_batches> sizes{};
    const int batches = round.batches();
    const auto pixel = (static_cast<std::uint64_t>(y) << 32) | static_cast<std::uint64_t>(x);
    for (int b = 0; b < batches; ++b) {
        const auto i = static_cast<std::size_t>(b);
        // Batch sizes differ by no more than one.
        sizes[i] = (b + 1) * round.samples / batches - b * round.samples / batches;
        const auto number = (static_cast<std::uint64_t>(pixels_.first_sample()) << k_part_shift) +
                            static_cast<std::uint64_t>(round.number) * PathRound::k_batches + i;
        sum.begin_batch();
        trace(x, y, {pixel, number, sizes[i]}, scratch, sum, traced);
        means[i] = sum.batch() / sizes[i];
    }
    const double weight = 1.0 / round.samples;
    result.alpha *= weight;
    for (Spectrum PixelResult::*part :
         {&PixelResult::direct, &PixelResult::backscatter, &PixelResult::backscatter_first,
          &PixelResult::multiple_volume, &PixelResult::multiple_surface})
        result.*part *= weight;
    for (std::vector<Spectrum>* list : {&result.lamps, &result.orders, &result.reflections})
        for (Spectrum& light : *list) light *= weight;
    if (!has_ray) result.pixel_factor = pixels_.pixel_factor(view);
    // The variance of a batch's mean falls as 1 / its size.
    for (std::size_t band = 0; band < bands && batches > 1; ++band) {
        const double mean = result.direct[band] + result.backscatter[band] +
                            result.multiple_volume[band] + result.multiple_surface[band];
        double spread = 0;
        for (std::size_t b = 0; b < static_cast<std::size_t>(batches); ++b) {
            const double deviation = means[b][band] - mean;
            spread += sizes[b] * weight * deviation * deviation;
        }
        result.error[band] = result.pixel_factor * std::sqrt(spread / (batches - 1));
    }
    pixels_.weigh(x, y, result);
}

/// Renders everything but the light that paths estimate, which is set to 0.
void PathPixels::render_without_paths(int x, int y, const PathRound& round, PixelView& view,
                                      PixelResult& result) const {
    pixels_.trace(x, y, view);
    if (round.number == 0) {
        SurfaceLight light;
        const std::vector<double> no_in_scatter(pixels_.in_scatter().value_count(), 0.0);
        pixels_.light_surfaces(std::span(&view, 1), light);
        pixels_.shade(view, light, 0, no_in_scatter, result);
        for (Spectrum& lamp : result.lamps) lamp = {};
        result.direct = {};
        result.alpha = 0;
    } else {
        const bool lamps = pixels_.in_scatter().parts().lamps;
        result.reset(lamps ? static_cast<std::size_t>(pixels_.lamp_count()) : 0);
        result.pixel_factor = pixels_.pixel_factor(view);
    }
    result.orders.assign(order_count_, Spectrum{});
    result.reflections.assign(order_count_, Spectrum{});
}

void PathPixels::trace(int x, int y, const Batch& batch, Scratch& scratch, Sum& sum,
                       const TracedCallback& traced) const {
    auto& [view, rays, indices, hits, found, samples, surfaces, light, lamps, segment, behind] =
        scratch;
    for (int first = 0; first < batch.samples; first += k_rays_at_once) {
        throw_if_stopped();
        const int end = std::min(first + k_rays_at_once, batch.samples);
        rays.clear();
        indices.clear();
        samples.clear();
        surfaces.clear();
        for (int i = first; i < end; ++i) {
            PathRandom random = batch.random(k_position, i);
            const double across = x + random.next();
            const double down = y + random.next();
            const std::optional<Ray> ray = camera_ray(pixels_.rays(), across, down, random);
            if (!ray) continue;
            rays.push_back(*ray);
            indices.push_back(i);
            samples.push_back({*ray, {}, across, down});
            if (view.ray) continue;  // only the pixel's edge sees water
            view.ray = ray;
            view.x = across;
            view.y = down;
        }
        hits.resize(rays.size());
        found.resize(rays.size());
        pixels_.scene().surfaces->closest_hits(rays, k_far, hits, found);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            if (found[i] == 0) continue;
            samples[i].hit = hits[i];
            surfaces.push_back(&samples[i]);
        }
        pixels_.transport().surfaces->evaluate(surfaces, light);
        std::size_t light_index = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const SurfaceSample* const surface = found[i] != 0 ? &samples[i] : nullptr;
            trace_path(surface, rays[i], light, light_index, batch, indices[i], scratch, sum);
            if (surface != nullptr) ++light_index;
            add_lamps_in_view(rays[i], surface != nullptr ? surface->hit.distance : k_far, lamps,
                              sum);
            if (surface != nullptr && surface->hit.glass != 0)
                trace_behind_glass(*surface, batch, indices[i], scratch, sum);
        }
        sum.add_rays(rays.size());
        traced(end - first);
    }
}

/// Prepares the camera segment, and adds what the surface emits and its direct light.
void PathPixels::begin(const SurfaceSample* surface, const Ray& ray, const SurfaceLight& light,
                       std::size_t light_index, CameraSegment& segment, Sum& sum) const {
    Spectrum leaving;
    if (surface != nullptr) {
        sum.set_part(&PixelResult::direct);
        add_direct_light(pixels_.scene(), *surface, light, light_index, sum, leaving);
    }
    pixels_.transport().paths->begin(ray, surface != nullptr ? &surface->hit : nullptr,
                                     leaving.first(sum.bands()), segment);
}

/// Adds the light of lamps that the ray crosses within `max_distance`, that of the surface it hits.
void PathPixels::add_lamps_in_view(const Ray& ray, double max_distance,
                                   std::vector<SeenLamp>& lamps, Sum& sum) const {
    lamps.clear();
    pixels_.lamps_in_view().append(ray, max_distance, lamps);
    sum.set_part(&PixelResult::direct);
    const int vertex = sum.add_vertex(k_no_vertex, {PathVertex::Kind::camera, ray.origin});
    for (const SeenLamp& lamp : lamps)
        sum.add({.lamp = lamp.lamp,
                 .distance = lamp.distance,
                 .radiance = lamp.arriving.first(sum.bands()),
                 .vertex = vertex,
                 .place = ray.at(lamp.distance)});
}

/// Follows a camera ray on from the glass that it meets, reflected or refracted at random at each
/// surface, with the light that arrives along each of its legs. Precondition: the segment is that
/// of the ray, up to the glass.
void PathPixels::trace_behind_glass(const SurfaceSample& glass, const Batch& batch, int index,
                                    Scratch& scratch, Sum& sum) const {
    constexpr const GlassLegOptions& options = k_glass_leg_options;
    const LitScene& scene = pixels_.scene();
    const GlassOptics& optics = *scene.glass;
    const std::size_t bands = sum.bands();
    PathRandom random = batch.random(k_glass, index);
    GlassRay ray{glass.ray, {}};
    SurfaceSample sample = glass;
    Spectrum weight = scratch.segment.transmittance;
    Batch leg = batch;
    for (int i = 0; i < options.max_surfaces; ++i) {
        if (sample.hit.glass != 0) {
            const GlassSplit split = optics.split(ray, sample.hit);
            double reflected = 0, transmitted = 0;
            for (std::size_t b = 0; b < bands; ++b) {
                reflected += weight[b] * split.reflectance[b];
                transmitted += weight[b] * split.transmittance[b];
            }
            if (!(reflected + transmitted > 0)) break;
            const bool is_reflected = random.next() * (reflected + transmitted) < reflected;
            weight *= is_reflected ? split.reflectance : split.transmittance;
            weight *= (reflected + transmitted) / (is_reflected ? reflected : transmitted);
            ray = is_reflected ? split.reflected : split.transmitted;
        } else {
            const WaterSurface& surface = *scene.water_surface;
            weight *= surface.reflectance_from_water(
                -glm::dot(ray.ray.direction, sample.hit.geometric_normal));
            ray = {surface.reflected(ray.ray, {sample.hit.distance, -sample.hit.geometric_normal}),
                   {}};
        }
        const double largest = weight.greatest(bands);
        if (largest < options.min_weight) {
            if (!(random.next() * options.min_weight < largest)) break;
            weight *= options.min_weight / largest;
        }
        sample.ray = ray.ray;
        const bool has_hit = scene.surfaces->closest_hit(ray.ray, k_far, sample.hit);
        const bool is_in_water = ray.around.glass() == 0;
        SurfaceLight& light = scratch.light_behind;
        if (has_hit) pixels_.transport().surfaces->evaluate_one(sample, light);
        sum.set_weight(weight);
        sum.set_first_slab({});
        if (is_in_water) {
            ++leg.leg;
            trace_path(has_hit ? &sample : nullptr, ray.ray, light, 0, leg, index, scratch, sum);
            add_lamps_in_view(ray.ray, has_hit ? sample.hit.distance : k_far, scratch.lamps, sum);
            if (!has_hit) break;
            weight *= scratch.segment.transmittance;
        } else {
            if (!has_hit) break;
            optics.absorb(ray.around, sample.hit.distance, weight);
            std::ranges::fill(light.to_camera(0), 1.0);
            sum.set_weight(weight * optics.radiance_in_water(ray.around));
            sum.set_part(&PixelResult::direct);
            Spectrum leaving;
            if (sample.hit.glass == 0) add_direct_light(scene, sample, light, 0, sum, leaving);
        }
        if (!is_specular(sample.hit)) break;
    }
    sum.reset_weight();
}

void PathPixels::trace_path(const SurfaceSample* surface, const Ray& ray, const SurfaceLight& light,
                            std::size_t light_index, const Batch& batch, int index,
                            Scratch& scratch, Sum& sum) const {
    CameraSegment& segment = scratch.segment;
    begin(surface, ray, light, light_index, segment, sum);
    segment.multiply_paths(path_counts_);
    if (pixels_.in_scatter().parts().first_slab && batch.leg == 0)
        sum.set_first_slab(pixels_.in_scatter().first_slab_along(ray));
    sum.set_part(&PixelResult::backscatter);
    PathRandom random = batch.random(k_single, index);
    pixels_.transport().paths->trace_single(segment, random, sum);
    for (const Kind& kind : k_kinds) {
        sum.set_part(kind.part);
        random = batch.random(kind.stream, index);
        kind.trace(*pixels_.transport().paths, segment, random, sum);
    }
}

namespace {

constexpr int k_places_across = 12;  // places of a trial across and down the image

}  // namespace

PathTrial PathPixels::run_trial(double x, double y, std::uint64_t place, int paths) const {
    SurfaceLight light;
    CameraSegment segment;
    PathTrial trial;
    const Batch batch{place, ~std::uint64_t{0}, paths};
    PathRandom random = batch.random(k_position, 0);
    const std::optional<Ray> ray = camera_ray(pixels_.rays(), x, y, random);
    if (!ray) return trial;
    SurfaceSample sample{*ray, {}, x, y};
    const bool has_hit = pixels_.scene().surfaces->closest_hit(*ray, k_far, sample.hit);
    if (has_hit) pixels_.transport().surfaces->evaluate_one(sample, light);
    PixelResult ignored;
    Sum sum(ignored, static_cast<std::size_t>(pixels_.band_count()));
    const auto end_batch = [&] {
        double radiance = 0;
        for (const double value : sum.batch().first(sum.bands()))
            radiance += value / static_cast<double>(sum.bands());
        sum.begin_batch();
        return radiance;
    };
    sum.begin_batch();
    begin(has_hit ? &sample : nullptr, *ray, light, 0, segment, sum);
    const PathTracer& tracer = *pixels_.transport().paths;
    random = batch.random(k_single, 0);
    tracer.trace_single(segment, random, sum);
    trial.single = end_batch();
    for (std::size_t k = 0; k < k_kinds.size(); ++k) {
        double squares = 0;
        PathTrial::OfKind& kind = trial.kinds[k];
        for (int i = 0; i < paths; ++i) {
            random = batch.random(k_kinds[k].stream, i);
            kind.work += k_kinds[k].trace(tracer, segment, random, sum) / paths;
            const double radiance = end_batch();
            kind.mean += radiance / paths;
            squares += radiance * radiance / paths;
        }
        kind.variance = std::max(0.0, squares - kind.mean * kind.mean);
    }
    return trial;
}

PathTrial PathPixels::run_trial(int paths) const {
    const RaySource& rays = pixels_.rays();
    std::array<PathTrial, k_places_across * k_places_across> trials;
    parallel_for(trials.size(), [&](std::size_t n) {
        const double across = static_cast<double>(n % k_places_across) + 0.5;
        const double down = static_cast<double>(n / k_places_across) + 0.5;
        trials[n] = run_trial(across * rays.width() / k_places_across,
                              down * rays.height() / k_places_across, n, paths);
    });
    PathTrial all;
    for (const PathTrial& trial : trials) {
        all.single += trial.single;
        for (std::size_t k = 0; k < all.kinds.size(); ++k) {
            all.kinds[k].mean += trial.kinds[k].mean;
            all.kinds[k].variance += trial.kinds[k].variance;
            all.kinds[k].work += trial.kinds[k].work;
        }
    }
    return all;
}

// For paths with variance v and cost t, numbers in proportion to sqrt(v / t) minimize the variance
// for a given time: 1 / (variance * time) is greatest (Veach 1997).
void PathPixels::allocate_paths(int samples) {
    constexpr int k_min = 8, k_max = 64;  // paths of a kind at each place
    constexpr double k_fraction = 0.03;   // of all paths that the trial takes
    const RaySource& rays = pixels_.rays();
    const double all = static_cast<double>(rays.width()) * rays.height() * samples;
    const PathTrial trial = run_trial(std::clamp(
        static_cast<int>(k_fraction * all / (k_places_across * k_places_across)), k_min, k_max));
    path_counts_ = {};
    std::array<double, k_kinds.size()> allocation{};
    double work = 0, allocated = 0;
    for (std::size_t k = 0; k < k_kinds.size(); ++k) {
        const PathTrial::OfKind& kind = trial.kinds[k];
        if (!(kind.work > 0)) continue;
        allocation[k] = std::sqrt(kind.variance / kind.work);
        work += kind.work;
        allocated += kind.work * allocation[k];
    }
    if (!(allocated > 0)) return;
    for (std::size_t k = 0; k < k_kinds.size(); ++k)
        path_counts_.*k_kinds[k].count = allocation[k] * work / allocated;
}

namespace {

// Number of adjacent pixels that one task renders.
constexpr int k_run = 8;
// Number of paths between two reports of progress: milliseconds of work.
constexpr std::uint64_t k_report = 64;
// The standard error is itself an estimate: trace a few more paths than follow from it.
constexpr double k_safety_factor = 1.05;
// The number of paths per pixel that an image with a target error is assumed to need before its
// first round.
constexpr int k_initial_samples = 64;

// A round has at least this fraction of the paths of all previous rounds.
constexpr double k_min_growth = 0.125;

constexpr int k_batches = PathRound::k_batches;

// Returns the total number of paths per pixel that is expected to reach the error.
double samples_needed(double error, const PathAccuracy& so_far) {
    const double ratio = so_far.error.value_or(0.0) / error;
    return k_safety_factor * so_far.samples * ratio * ratio;
}

// An estimate of the error takes two paths.
int samples_of_pixel(int mean_samples, double weight) {
    return std::max(2, static_cast<int>(std::lround(mean_samples * weight)));
}

/// Statistics of the total of every pixel: the variance of its estimate, by band, its mean over the
/// bands, and the number of paths.
class Spread {
  public:
    Spread(const PixelWindow& window, std::size_t bands) : window_(window), bands_(bands) {
        const double bytes =
            4.0 * static_cast<double>(bands_ + 3) * window.width() * window.height();
        require_memory(bytes,
                       fmt::format("camera.resolution: the standard error of {} x {} pixels needs",
                                   window.width(), window.height()),
                       "render it in parts, with --crop, or make it smaller, with --size");
        values_.assign(window.width() * static_cast<int>(bands_ + 2), window.height());
    }

    /// Merges further paths of a pixel. Returns their fraction of all of its paths.
    double merge(int x, int y, const PixelResult& result, int samples) {
        const std::span<float> own = pixel(x, y);
        float& count = own[bands_ + 1];
        count += static_cast<float>(samples);
        const double fraction = samples / static_cast<double>(count);
        double light = 0;
        for (std::size_t b = 0; b < bands_; ++b) {
            const double before = (1 - fraction) * (1 - fraction) * static_cast<double>(own[b]);
            const double more = fraction * result.error[b];
            own[b] = static_cast<float>(before + more * more);
            light += result.direct[b] + result.backscatter[b] + result.multiple_volume[b] +
                     result.multiple_surface[b];
        }
        const double mean = result.pixel_factor * light / static_cast<double>(bands_);
        own[bands_] =
            static_cast<float>((1 - fraction) * static_cast<double>(own[bands_]) + fraction * mean);
        return fraction;
    }

    /// The mean number of paths per pixel.
    int samples() const {
        double sum = 0;
        for (int y = window_.y0; y < window_.y1; ++y)
            for (int x = window_.x0; x < window_.x1; ++x)
                sum += static_cast<double>(pixel(x, y)[bands_ + 1]);
        return static_cast<int>(std::lround(sum / window_.width() / window_.height()));
    }

    /// Returns the number of paths for each pixel in the next rounds, relative to the mean over all
    /// pixels. Numbers in proportion to the standard deviation of a single path give the least
    /// error of the image. The deviation is estimated from the pixels around a pixel, never from
    /// its own paths, since adapting to these would bias it: a pixel that is too dark by chance has
    /// found no bright path, seems to need few more, and would stay too dark.
    Grid2D<float> find_path_weights() const {
        constexpr int k_radius = 3;
        constexpr double k_min_weight = 0.25, k_max_weight = 8;
        Grid2D<float> path_weights;
        path_weights.assign(window_.width(), window_.height());
        const auto deviation = [&](int x, int y) {
            double variance = 0;
            for (const float of_band : pixel(x, y).first(bands_))
                variance += static_cast<double>(of_band);
            return std::sqrt(variance);
        };
        double mean = 0;
        for (int y = window_.y0; y < window_.y1; ++y)
            for (int x = window_.x0; x < window_.x1; ++x) mean += deviation(x, y);
        mean /= static_cast<double>(path_weights.size());
        parallel_for(static_cast<std::size_t>(window_.height()), [&](std::size_t row) {
            const int y = window_.y0 + static_cast<int>(row);
            for (int x = window_.x0; x < window_.x1; ++x) {
                double sum = 0;
                int count = 0;
                for (int v = std::max(y - k_radius, window_.y0);
                     v < std::min(y + k_radius + 1, window_.y1); ++v) {
                    for (int u = std::max(x - k_radius, window_.x0);
                         u < std::min(x + k_radius + 1, window_.x1); ++u) {
                        if (u == x && v == y) continue;
                        sum += deviation(u, v);
                        ++count;
                    }
                }
                const double weight = count > 0 && mean > 0 ? sum / count / mean : 1;
                path_weights(x - window_.x0, y - window_.y0) =
                    static_cast<float>(std::clamp(weight, k_min_weight, k_max_weight));
            }
        });
        return path_weights;
    }

    /// Returns the standard error of the whole image, relative to its mean.
    double error() const {
        double variance = 0, mean = 0;
        for (int y = window_.y0; y < window_.y1; ++y) {
            for (int x = window_.x0; x < window_.x1; ++x) {
                const std::span<const float> own = pixel(x, y);
                for (std::size_t b = 0; b < bands_; ++b) variance += static_cast<double>(own[b]);
                mean += static_cast<double>(own[bands_]);
            }
        }
        if (variance == 0) return 0;
        const double pixels = static_cast<double>(window_.width()) * window_.height();
        return std::sqrt(variance / (pixels * static_cast<double>(bands_))) / (mean / pixels);
    }

    /// Writes the standard error of a pixel, by band.
    void store_error(int x, int y, std::span<float> channels) const {
        const std::span<const float> own = pixel(x, y);
        for (std::size_t b = 0; b < bands_; ++b)
            channels[b] = static_cast<float>(std::sqrt(static_cast<double>(own[b])));
    }

  private:
    std::size_t first(int x) const {
        return static_cast<std::size_t>(x - window_.x0) * (bands_ + 2);
    }
    std::span<float> pixel(int x, int y) {
        return values_.row(y - window_.y0).subspan(first(x), bands_ + 2);
    }
    std::span<const float> pixel(int x, int y) const {
        return values_.row(y - window_.y0).subspan(first(x), bands_ + 2);
    }

    PixelWindow window_;
    std::size_t bands_;
    Grid2D<float> values_;
};

/// Reports the progress of an image whose total number of paths may not be known yet.
class RoundProgress {
  public:
    RoundProgress(const ProgressCallback& progress, const PixelWindow& window)
        : progress_(progress), pixels_(static_cast<double>(window.width()) * window.height()) {}

    void begin_round(double samples_in_all) { all_ = pixels_ * samples_in_all; }

    /// Thread safe.
    void add(int paths) {
        const auto more = static_cast<std::uint64_t>(paths);
        const std::uint64_t before = done_.fetch_add(more);
        if (before / k_report == (before + more) / k_report) return;
        // The rest may take longer than expected.
        constexpr double k_almost = 0.99;
        progress_(std::min(k_almost, static_cast<double>(before + more) / all_));
    }

  private:
    const ProgressCallback& progress_;
    double pixels_;
    double all_ = 1;  // paths
    std::atomic<std::uint64_t> done_ = 0;
};

}  // namespace

int samples_of_next_round(const PathGoal& goal, const PathAccuracy& so_far) {
    if (!goal.error) return so_far.samples == 0 ? goal.samples : 0;
    if (so_far.samples == 0) return k_batches;
    const int possible = k_max_paths - so_far.samples;
    if (possible <= 0 || so_far.error.value_or(0.0) <= *goal.error) return 0;
    // Prefer batches of 2^k paths, which the lattice stratifies best. A round that turns out too
    // small is made up for by the next.
    const double missing = samples_needed(*goal.error, so_far) - so_far.samples;
    const double needed = std::min({missing, 2.0 * so_far.samples, static_cast<double>(possible)});
    const double wanted = std::max(needed, k_min_growth * so_far.samples);
    int samples = k_batches;
    while (2 * samples <= wanted) samples *= 2;
    return std::min(samples, possible);
}

PathPass::PathPass(const RenderDesc& render, const PathRequest& request)
    : Pass(Stage::render),
      request_(request),
      has_error_(request.error || samples_of(render) > 1),
      needs_slabs_(render.planes.near || render.planes.far) {}

PassNeeds PathPass::needs(const LayerPlan& plan) const {
    return {.slabs = needs_slabs_ || in_scatter_parts(plan).first_slab, .paths = true};
}

void PathPass::provide(LayerSupply& supply) const {
    supply.layers |= {Layer::multiple, Layer::multiple_volume, Layer::multiple_surface};
    if (has_error_) supply.layers |= {Layer::error};
    supply.orders = request_.orders;
}

void PathPass::run(Rendering& rendering) {
    const LayerPlan& plan = rendering.plan;
    const PathGoal goal{samples_of(rendering.desc.render), request_.error};
    const ProgressCallback progress = rendering.progress_of(*stage());
    PathPixels pixels(rendering.pixels, plan.order_count());
    pixels.allocate_paths(goal.error ? k_initial_samples : goal.samples);
    Film& film = rendering.film;
    const PixelWindow& window = film.window();
    Spread spread(window, plan.band_count());
    RoundProgress so_far(progress, window);
    const int runs = (window.width() + k_run - 1) / k_run;  // in a row
    const auto tasks = static_cast<std::size_t>(runs) * static_cast<std::size_t>(window.height());
    PathAccuracy accuracy;
    PathRound round;
    Grid2D<float> path_weights;  // of the pixels, set after the first round
    for (; (round.samples = samples_of_next_round(goal, accuracy)) > 0; ++round.number) {
        const int samples = accuracy.samples + round.samples;
        double in_all = samples;
        if (goal.error)
            in_all = std::clamp(
                round.number == 0 ? k_initial_samples : samples_needed(*goal.error, accuracy),
                in_all, static_cast<double>(k_max_paths));
        so_far.begin_round(in_all);
        parallel_for(tasks, [&](std::size_t task) {
            PixelResult result;
            const int y = window.y0 + static_cast<int>(task) / runs;
            const int begin = window.x0 + static_cast<int>(task) % runs * k_run;
            for (int x = begin; x < std::min(begin + k_run, window.x1); ++x) {
                PathRound of_pixel = round;
                if (round.number > 0)
                    of_pixel.samples = samples_of_pixel(
                        round.samples,
                        static_cast<double>(path_weights(x - window.x0, y - window.y0)));
                pixels.render(
                    x, y, of_pixel, [&](int paths) { so_far.add(paths); }, result);
                const double fraction = spread.merge(x, y, result, of_pixel.samples);
                if (round.number == 0)
                    store_pixel(result, plan, rendering.colour, film.pixel(x, y));
                else
                    merge_paths(result, fraction, plan, rendering.colour, film.pixel(x, y));
                if (result.shows_lamp) film.mark_lamp(x, y);
            }
        });
        accuracy.samples = spread.samples();
        if (samples > 1) accuracy.error = spread.error();
        // Compute them from the first round alone: the sizes of later rounds depend on them, so
        // that the number of a pixel's paths would depend on its own estimate after all.
        if (goal.error && round.number == 0) path_weights = spread.find_path_weights();
        rendering.reached.paths = accuracy;
    }
    if (plan.has(Layer::error))
        for (int y = window.y0; y < window.y1; ++y)
            for (int x = window.x0; x < window.x1; ++x)
                spread.store_error(x, y, plan.channels(Layer::error, film.pixel(x, y)));
    progress(1);
}

}  // namespace uw
