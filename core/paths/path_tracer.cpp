#include "core/paths/path_tracer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/error.h"
#include "core/base/numerics.h"
#include "core/paths/irradiance_cache.h"
#include "core/paths/path_tables.h"
#include "core/paths/scattering_tables.h"

namespace uw {

namespace {

/// The density of the first scattering, along the camera ray: uniform in each of some intervals,
/// and between them in proportion to what light they are expected to scatter.
struct FirstScatteringOptions {
    /// Paths are not followed beyond this optical depth of the camera ray: e^-20 = 2e-9.
    double max_depth = 20;
    /// The intervals in which the transmittance falls by as much.
    int intervals = 8;
    /// Beyond the first of these optical depths, intervals are no longer than the second: the light
    /// of an interval is judged by its middle.
    double far_depth = 1.5, far_step = 0.5;
    /// About the number of knots of a profile at which intervals end: most of them in a plume.
    std::size_t max_knots = 64;
    /// The places along the ray at which the lamps' guides are looked up. Between them the light is
    /// followed.
    std::size_t max_guides = 6;
    /// The probability with which the density follows the transmittance alone, so that no interval
    /// is starved (defensive sampling, Hesterberg 1995).
    double defensive_probability = 0.1;
};
constexpr FirstScatteringOptions k_first_scattering_options;

/// What a path may meet anywhere (ExpectedLight::ambient).
struct AmbientOptions {
    /// Relative to the radiance of the surface that the pixel sees.
    double of_surface = 0.5;
    /// And at least, relative to the pixel's radiance.
    double min_of_pixel = 0.05;
};
constexpr AmbientOptions k_ambient_options;

/// The mean number of paths of a kind in place of one.
struct PathCountOptions {
    /// Relative to the fraction of the pixel's light that the kind is expected to bring.
    double per_fraction = 4;
    /// The limits.
    double min = 0.1, max = 8;
};
constexpr PathCountOptions k_path_count_options;

// The state of a path at the camera, with a throughput of 1.
PathState begin_path(const CameraSegment& segment, std::size_t bands, ContributionSink& sink) {
    PathState state;
    state.ray = segment.water.ray;
    std::ranges::fill(state.throughput.first(bands), 1.0);
    state.expected = segment.expected;
    state.vertex =
        sink.add_vertex(k_no_vertex, {PathVertex::Kind::camera, segment.water.ray.origin});
    return state;
}

// That of one of `count` paths which together stand for one.
PathState begin_path_of(double count, const CameraSegment& segment, std::size_t bands,
                        ContributionSink& sink) {
    PathState state = begin_path(segment, bands, sink);
    for (double& value : state.throughput.first(bands)) value /= count;
    state.expected.pixel /= std::max(1.0, count);
    state.from_water = true;
    return state;
}

// Traces `mean` paths on average, and returns what work they were. A whole number takes no random
// number: the first of them covers its range the most evenly.
template <class Trace>
double trace_paths(double mean, PathRandom& random, const Trace& trace) {
    double work = 0;
    int count = static_cast<int>(mean);
    const double rest = mean - count;
    if (rest > 0 && random.next() < rest) ++count;
    for (int i = 0; i < count; ++i) work += trace();
    return work;
}

class NoContributions final : public ContributionSink {
  public:
    void add(const PathContribution&) override {}
};

}  // namespace

PathTracer::PathTracer(const LitScene& scene,
                       const std::vector<std::shared_ptr<const DeepShadow>>& deep_shadows,
                       std::shared_ptr<const ScatteringTables> scattering)
    : scattering_(scattering ? std::move(scattering)
                             : std::make_shared<const ScatteringTables>(*scene.medium)),
      emission_(scene),
      views_(lamp_views(*scene.emitters)) {
    for (const LampView& view : views_) {
        LitScene seen = scene;
        seen.emitters = &view.lamps;
        std::vector<std::shared_ptr<const DeepShadow>> of_view;
        if (!deep_shadows.empty())
            for (const std::size_t emitter : view.emitters)
                of_view.push_back(deep_shadows[emitter]);
        tables_.push_back(std::make_unique<PathTables>(seen, *scattering_, emission_,
                                                       std::move(of_view), view.emitters));
    }
}

PathTracer::~PathTracer() = default;

// A path sees one point of each lamp.
const PathTables& PathTracer::choose_tables(PathRandom& random) const {
    if (tables_.size() == 1) return *tables_.front();
    const double place = random.next() * static_cast<double>(tables_.size());
    return *tables_[std::min(static_cast<std::size_t>(place), tables_.size() - 1)];
}

void PathTracer::begin(const Ray& ray, const SurfaceHit* hit, std::span<const double> surface_light,
                       CameraSegment& segment) const {
    PathScratch& scratch = segment.scratch;
    const WaterOptics& optics = tables_.front()->optics;
    WaterSegment& water = segment.water;
    optics.set(ray, hit, water);
    optics.look_up(water, water.length, scratch.point);
    segment.transmittance = {};
    if (hit) optics.transmittances(water.length, scratch.point.column, segment.transmittance);
    scratch.passages.clear();
    for (const Lamp& lamp : *optics.scene().emitters) scratch.passages.push_back(lamp.passage(ray));
    place_intervals(scratch.passages, segment);
    weigh_intervals(surface_light, segment);
}

// The intervals end at equal steps of the transmittance, at the lamps' nearest points, and at knots
// of the concentrations.
void PathTracer::place_intervals(std::span<const LampPassage> passages,
                                 CameraSegment& segment) const {
    constexpr const FirstScatteringOptions& options = k_first_scattering_options;
    const WaterOptics& optics = tables_.front()->optics;
    const WaterSegment& water = segment.water;
    std::vector<double>& s = segment.distances;
    const double c = optics.attenuation().uniform[optics.clearest_band()];
    double end = c > 0 ? std::min(water.length, options.max_depth / c) : water.length;
    s.assign(1, 0.0);
    const ConcentrationProfile& profile = water.profile;
    if (!profile.s.empty()) {
        const std::size_t stride = 1 + profile.s.size() / options.max_knots;
        double last_full = 0;
        for (std::size_t i = 0; i + 1 < profile.s.size(); ++i) {
            if (profile.empty_between(i)) {
                s.push_back(profile.s[i]);
                s.push_back(profile.s[i + 1]);
            } else {
                if (i % stride == 0) s.push_back(profile.s[i]);
                last_full = profile.s[i + 1];
            }
        }
        s.push_back(last_full);
        if (c == 0) end = std::min(end, last_full);
    }
    const double depth = c * end, lost = std::expm1(-depth);
    for (int i = 1; i < options.intervals; ++i) {
        const double fraction = static_cast<double>(i) / options.intervals;
        s.push_back(c > 0 ? -std::log1p(fraction * lost) / c : fraction * end);
    }
    for (double tau = options.far_depth; tau < depth; tau += options.far_step) s.push_back(tau / c);
    for (const LampPassage& passage : passages) {
        if (passage.parallel) {
            if (passage.slope != 0) s.push_back(-passage.begin_length / passage.slope);
            continue;
        }
        for (const double octave : {-1.0, 0.0, 1.0})
            s.push_back(passage.foot + octave * passage.distance);
    }
    s.push_back(end);
    std::erase_if(s, [&](double at) { return !(at >= 0 && at <= end); });
    std::ranges::sort(s);
    s.erase(std::unique(s.begin(), s.end()), s.end());
}

// Sets the radiance of the segment's surface, by band, to what is known of it and what the lamps'
// radiance in infinite water lets expect. Returns the mean of the latter as it arrives at the
// camera.
double PathTracer::expect_surface(CameraSegment& segment, std::span<const double> surface_light,
                                  Spectrum& radiance) const {
    const PathTables& tables = *tables_.front();
    const std::size_t bands = tables.optics.bands();
    radiance = {};
    std::ranges::copy(surface_light, radiance.begin());
    if (!segment.water.has_hit) return 0;
    double all = 0;
    for (const double value : segment.transmittance.first(bands)) all += value;
    const double estimate = estimated_reflection(tables.guides, segment.water.hit,
                                                 all > 0 ? segment.transmittance : tables.light,
                                                 segment.scratch.column);
    double arriving = 0;
    for (std::size_t b = 0; b < bands; ++b) {
        radiance[b] = std::max(radiance[b], estimate);
        arriving += estimate * segment.transmittance[b];
    }
    return arriving / static_cast<double>(bands);
}

void PathTracer::weigh_intervals(std::span<const double> surface_light,
                                 CameraSegment& segment) const {
    constexpr const FirstScatteringOptions& options = k_first_scattering_options;
    const PathTables& tables = *tables_.front();
    const WaterOptics& optics = tables.optics;
    const std::size_t bands = optics.bands();
    const WaterSegment& water = segment.water;
    const std::vector<double>& s = segment.distances;
    Spectrum light_of_surface, weights;
    // Light of the sky that is scattered is that of lamps.
    const bool has_surface = water.has_hit && !is_specular(water.hit) && !surface_light.empty();
    const double reflected =
        has_surface ? expect_surface(segment, surface_light, light_of_surface) : 0;
    PathScratch& scratch = segment.scratch;
    WaterPoint& point = scratch.point;
    std::vector<double>&guided = scratch.guided, &plain = scratch.plain;
    guided.clear();
    plain.clear();
    double sum_guided = 0, sum_plain = 0, of_water = 0;
    const std::size_t count = s.size() - 1, stride = 1 + (count - 1) / options.max_guides;
    const auto look_at = [&](double at) {
        optics.look_up(water, at, point);
        optics.find_scattering(point);
        optics.transmittances(at, point.column, weights);
    };
    for (std::size_t i = 0; i < count; ++i) {
        if (i % stride == 0) {
            const double from = s[i], to = s[std::min(i + stride, count)];
            const double at = 0.5 * (from + to);
            look_at(at);
            scratch.guides.find(tables.guides, water.ray.at(at), weights);
        }
        const double length = s[i + 1] - s[i], middle = 0.5 * (s[i] + s[i + 1]);
        look_at(middle);
        double scattered = 0, from_surface = 0, all_scattering = 0, clearest = 0;
        for (std::size_t b = 0; b < bands; ++b) {
            double scattering = 0;
            for (const Spectrum& m : point.scattering) scattering += m[b];
            scattered += weights[b] * scattering;
            all_scattering += scattering;
            clearest = std::max(clearest, weights[b]);
            // The surface, seen through the water by a small detour.
            if (has_surface)
                from_surface += scattering * light_of_surface[b] *
                                std::sqrt(weights[b] * segment.transmittance[b]);
        }
        const double from_water =
            scattered > 0
                ? scattered * (scratch.guides.source(water.ray.at(middle), water.ray.direction) +
                               tables.guides.particles.at(water.ray.at(middle)))
                : 0;
        of_water += from_water * length;
        guided.push_back((from_water + from_surface) * length);
        plain.push_back(all_scattering * clearest * length);
        sum_guided += guided.back();
        sum_plain += plain.back();
    }
    const double per_band = 1 / static_cast<double>(bands);
    segment.expected = {};
    for (std::size_t b = 0; b < bands; ++b) {
        segment.expected.of_surface += light_of_surface[b] * segment.transmittance[b] * per_band;
        segment.expected.ambient += k_ambient_options.of_surface * light_of_surface[b] * per_band;
    }
    segment.expected.pixel = sum_guided * per_band + segment.expected.of_surface;
    segment.expected.ambient =
        std::max(segment.expected.ambient, k_ambient_options.min_of_pixel * segment.expected.pixel);
    segment.paths = {};
    if (segment.expected.pixel > 0) {
        const auto count_of = [&](double light) {
            return std::clamp(k_path_count_options.per_fraction * light / segment.expected.pixel,
                              k_path_count_options.min, 1.0);
        };
        segment.paths.water = count_of(of_water * per_band);
        if (has_surface) segment.paths.surface = count_of(reflected);
    } else {
        // Nothing is known of it, as where only emission lights the scene: by throughput alone.
        segment.expected = {.pixel = 1, .ambient = 1 / k_ambient_beyond, .is_known = false};
    }
    segment.cumulative.clear();
    if (!(sum_plain > 0)) return;
    const double guided_probability = sum_guided > 0 ? 1 - options.defensive_probability : 0;
    double total = 0;
    for (std::size_t i = 0; i < plain.size(); ++i) {
        if (sum_guided > 0) total += guided_probability * guided[i] / sum_guided;
        total += (1 - guided_probability) * plain[i] / sum_plain;
        segment.cumulative.push_back(total);
    }
}

void PathTracer::trace_single(CameraSegment& segment, PathRandom& random,
                              ContributionSink& sink) const {
    const PathTables& tables = choose_tables(random);
    PathState state = begin_path(segment, tables.optics.bands(), sink);
    state.from_water = true;
    tables.lamps.estimate_in_scatter(segment.water, state, random, sink,
                                     segment.scratch.next_event);
}

// The first scattering lies where the light along the segment guides it.
double PathTracer::trace_water_path(CameraSegment& segment, PathRandom& random,
                                    ContributionSink& sink) const {
    PathScratch& scratch = segment.scratch;
    const PathTables& tables = choose_tables(random);
    const WaterOptics& optics = tables.optics;
    double u = random.next();
    const Choice interval = choose(segment.cumulative, u);
    const double begin = segment.distances[interval.index];
    const double length = segment.distances[interval.index + 1] - begin;
    if (!(interval.probability > 0)) return 0;
    PathState state = begin_path_of(segment.paths.water, segment, optics.bands(), sink);
    state.stays_in_water = true;
    state.distance = begin + u * length;
    WaterPoint& point = scratch.point;
    optics.look_up(segment.water, state.distance, point);
    optics.find_scattering(point);
    optics.transmittances(state.distance, point.column, state.throughput);
    for (double& value : state.throughput.first(optics.bands()))
        value *= length / (interval.probability * segment.paths.water);
    PathWalk walk(tables, random, sink, scratch);
    walk.trace_from_water(state, segment.water, point);
    return walk.work();
}

double PathTracer::trace_water(CameraSegment& segment, PathRandom& random,
                               ContributionSink& sink) const {
    if (segment.cumulative.empty()) return 0;
    return trace_paths(segment.paths.water, random,
                       [&] { return trace_water_path(segment, random, sink); });
}

double PathTracer::trace_lit_surface_path(CameraSegment& segment, const IrradianceCache* indirect,
                                          PathRandom& random, ContributionSink& sink) const {
    const PathTables& tables = choose_tables(random);
    PathState state = begin_path_of(segment.paths.lit, segment, tables.optics.bands(), sink);
    PathWalk walk(tables, random, sink, segment.scratch);
    const WaterSegment* end = walk.walk_to_surface(state, segment.water);
    if (end && indirect)
        walk.trace_lit_surface(state, *end, *indirect);
    else if (end)
        walk.trace_lit_surface(state, *end);
    return walk.work();
}

double PathTracer::trace_lit_surfaces(CameraSegment& segment, PathRandom& random,
                                      ContributionSink& sink) const {
    return trace_paths(segment.paths.lit, random,
                       [&] { return trace_lit_surface_path(segment, nullptr, random, sink); });
}

double PathTracer::trace_lit_surfaces(CameraSegment& segment, const IrradianceCache& indirect,
                                      PathRandom& random, ContributionSink& sink) const {
    return trace_paths(segment.paths.lit, random,
                       [&] { return trace_lit_surface_path(segment, &indirect, random, sink); });
}

bool PathTracer::find_lit_surface(CameraSegment& segment, PathRandom& random,
                                  SurfaceSample& sample) const {
    NoContributions sink;
    const PathTables& tables = *tables_.front();
    PathState state = begin_path_of(segment.paths.lit, segment, tables.optics.bands(), sink);
    PathWalk walk(tables, random, sink, segment.scratch);
    const WaterSegment* end = walk.walk_to_surface(state, segment.water);
    if (end) {
        sample.ray = end->ray;
        sample.hit = end->hit;
    }
    return end != nullptr;
}

double PathTracer::trace_surface(CameraSegment& segment, PathRandom& random,
                                 ContributionSink& sink) const {
    if (!segment.water.has_hit || is_specular(segment.water.hit)) return 0;
    return trace_paths(segment.paths.surface, random, [&] {
        const PathTables& tables = choose_tables(random);
        PathState state = begin_path(segment, tables.optics.bands(), sink);
        for (std::size_t b = 0; b < tables.optics.bands(); ++b)
            state.throughput[b] = segment.transmittance[b] / segment.paths.surface;
        state.distance = segment.water.length;
        PathWalk walk(tables, random, sink, segment.scratch);
        walk.trace_from_surface(state, {segment.water.ray, segment.water.hit, 0, 0});
        return walk.work();
    });
}

void PathTracer::trace_mirrored(const SurfaceSample& sample, PathRandom& random,
                                ContributionSink& sink, PathScratch& scratch) const {
    const PathTables& tables = choose_tables(random);
    PathState state;
    std::ranges::fill(state.throughput.first(tables.optics.bands()), 1.0);
    // Something may shine from everywhere, even where there is no lamp.
    state.expected = {.pixel = 1, .ambient = 1};
    state.distance = sample.hit.distance;
    PathWalk(tables, random, sink, scratch).trace_mirrored(state, sample);
}

void CameraSegment::multiply_paths(const PathCounts& times) {
    const auto multiply = [](double& count, double by) {
        count = std::clamp(count * by, k_path_count_options.min, k_path_count_options.max);
    };
    multiply(paths.water, times.water);
    multiply(paths.lit, times.lit);
    multiply(paths.surface, times.surface);
}

}  // namespace uw
