#include "core/paths/path_tracer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/error.h"
#include "core/base/numerics.h"
#include "core/light/ray_panels.h"
#include "core/paths/irradiance_cache.h"
#include "core/paths/next_event_estimator.h"
#include "core/paths/path_tables.h"
#include "core/paths/path_walk.h"
#include "core/paths/scattering_tables.h"

namespace uw {

namespace {

// The light that a path may meet anywhere, relative to that of the surface its pixel sees, and at
// least relative to the pixel's.
constexpr double k_ambient_share = 0.5, k_min_ambient = 0.05;
// Paths are not followed beyond this optical depth of the camera ray: e^-20 = 2e-9.
constexpr double k_reach = 20;
// Intervals of uniform water in which the first scattering is uniform; most of them in a plume.
constexpr int k_views_of_ray = 8;
constexpr double k_far_begin = 1.5, k_far_step = 0.5;
constexpr std::size_t k_max_knots = 64;
// Places along the ray at which the lamps' light is looked up: between them it is followed.
constexpr std::size_t k_max_guides = 6;
// Share of the first scatterings that follow the transmittance alone, so that none is starved.
constexpr double k_defensive_share = 0.1;
// The share of paths of a kind, relative to its share of the light, and at least.
constexpr double k_paths_of_share = 4, k_min_paths = 0.1, k_max_paths = 8;

/// Per thread: preparing a ray does not allocate.
struct Workspace {
    WaterPoint point;
    std::vector<LampPassage> passages;  // of the lamps
    std::vector<double> guided, plain;
    GuidingDistribution guides;
};

Workspace& workspace_of_thread() {
    thread_local Workspace workspace;
    return workspace;
}

int begin_path(const CameraSegment& segment, ContributionSink& sink) {
    return sink.add_vertex(k_no_vertex, {PathVertex::Kind::camera, segment.water.ray.origin});
}

}  // namespace

PathTracer::PathTracer(const LitScene& scene,
                       const std::vector<std::shared_ptr<const DeepShadow>>& deep_shadows,
                       std::shared_ptr<const ScatteringTables> scattering)
    : scattering_(scattering ? std::move(scattering)
                             : std::make_shared<const ScatteringTables>(*scene.medium)),
      views_(lamp_views(*scene.emitters)) {
    for (const LampView& view : views_) {
        LitScene seen = scene;
        seen.emitters = &view.lamps;
        std::vector<std::shared_ptr<const DeepShadow>> of_view;
        if (!deep_shadows.empty())
            for (const std::size_t emitter : view.emitters)
                of_view.push_back(deep_shadows[emitter]);
        tables_.push_back(
            std::make_unique<PathTables>(seen, *scattering_, std::move(of_view), view.emitters));
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
    Workspace& w = workspace_of_thread();
    const WaterOptics& optics = tables_.front()->optics;
    WaterSegment& water = segment.water;
    optics.set(ray, hit, water);
    optics.look_up(water, water.length, w.point);
    segment.transmittance = {};
    if (hit) optics.transmittances(water.length, w.point.column, segment.transmittance);
    w.passages.clear();
    for (const Lamp& lamp : *optics.scene().emitters) w.passages.emplace_back(ray, lamp);
    place_intervals(segment);
    weigh_intervals(surface_light, segment);
}

// The ends of the intervals: at equal steps of the transmittance, at the lamp's nearest points, and
// at knots of the concentrations.
void PathTracer::place_intervals(CameraSegment& segment) const {
    Workspace& w = workspace_of_thread();
    const WaterOptics& optics = tables_.front()->optics;
    const WaterSegment& water = segment.water;
    std::vector<double>& s = segment.distances;
    const double c = optics.attenuation().uniform[optics.clearest_band()];
    double reach = c > 0 ? std::min(water.length, k_reach / c) : water.length;
    s.assign(1, 0.0);
    const ConcentrationProfile& profile = water.profile;
    if (!profile.s.empty()) {
        const std::size_t stride = 1 + profile.s.size() / k_max_knots;
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
        if (c == 0) reach = std::min(reach, last_full);
    }
    // At equal steps of the transmittance, but at most half an optical depth apart: the light of an
    // interval is judged by its middle.
    const double depth = c * reach, lost = std::expm1(-depth);
    for (int i = 1; i < k_views_of_ray; ++i) {
        const double share = static_cast<double>(i) / k_views_of_ray;
        s.push_back(c > 0 ? -std::log1p(share * lost) / c : share * reach);
    }
    for (double tau = k_far_begin; tau < depth; tau += k_far_step) s.push_back(tau / c);
    for (const LampPassage& passage : w.passages) {
        if (passage.parallel) {
            if (passage.slope != 0) s.push_back(-passage.begin_length / passage.slope);
            continue;
        }
        for (const double octave : {-1.0, 0.0, 1.0})
            s.push_back(passage.foot + octave * passage.distance);
    }
    s.push_back(reach);
    std::erase_if(s, [&](double at) { return !(at >= 0 && at <= reach); });
    std::ranges::sort(s);
    s.erase(std::unique(s.begin(), s.end()), s.end());
}

// The radiance of the segment's surface, by band: what is known of it, and what the lamps' field
// lets expect. Returns the mean of that as it arrives at the camera.
double PathTracer::estimate_surface_light(const CameraSegment& segment,
                                          std::span<const double> surface_light,
                                          Spectrum& light) const {
    const PathTables& tables = *tables_.front();
    const std::size_t bands = tables.optics.bands();
    light = {};
    std::ranges::copy(surface_light, light.begin());
    if (!segment.water.has_hit) return 0;
    double all = 0;
    for (const double value : segment.transmittance.first(bands)) all += value;
    const double guess = estimated_reflection(tables.guides, segment.water.hit,
                                              all > 0 ? segment.transmittance : tables.light);
    double arriving = 0;
    for (std::size_t b = 0; b < bands; ++b) {
        light[b] = std::max(light[b], guess);
        arriving += guess * segment.transmittance[b];
    }
    return arriving / static_cast<double>(bands);
}

void PathTracer::weigh_intervals(std::span<const double> surface_light,
                                 CameraSegment& segment) const {
    Workspace& w = workspace_of_thread();
    const PathTables& tables = *tables_.front();
    const WaterOptics& optics = tables.optics;
    const std::size_t bands = optics.bands();
    const WaterSegment& water = segment.water;
    const std::vector<double>& s = segment.distances;
    Spectrum light_of_surface, weights;
    // Light of the sky that is scattered is that of lamps.
    const bool has_surface = water.has_hit && !water.hit.is_water_surface && !surface_light.empty();
    const double reflected =
        has_surface ? estimate_surface_light(segment, surface_light, light_of_surface) : 0;
    w.guided.clear();
    w.plain.clear();
    double sum_guided = 0, sum_plain = 0, of_water = 0;
    const std::size_t count = s.size() - 1, stride = 1 + (count - 1) / k_max_guides;
    const auto look_at = [&](double at) {
        optics.look_up(water, at, w.point);
        optics.find_scattering(w.point);
        optics.transmittances(at, w.point.column, weights);
    };
    for (std::size_t i = 0; i < count; ++i) {
        if (i % stride == 0) {
            const double from = s[i], to = s[std::min(i + stride, count)];
            const double at = 0.5 * (from + to);
            look_at(at);
            w.guides.find(tables.guides, water.ray.at(at), weights);
        }
        const double length = s[i + 1] - s[i], middle = 0.5 * (s[i] + s[i + 1]);
        look_at(middle);
        double scattered = 0, from_surface = 0, plain = 0, clearest = 0;
        for (std::size_t b = 0; b < bands; ++b) {
            double scattering = 0;
            for (const Spectrum& m : w.point.scattering) scattering += m[b];
            scattered += weights[b] * scattering;
            plain += scattering;
            clearest = std::max(clearest, weights[b]);
            // The surface, seen through the water by a small detour.
            if (has_surface)
                from_surface += scattering * light_of_surface[b] *
                                std::sqrt(weights[b] * segment.transmittance[b]);
        }
        const double from_water =
            scattered > 0
                ? scattered * (w.guides.source(water.ray.at(middle), water.ray.direction) +
                               tables.guides.particles.at(water.ray.at(middle)))
                : 0;
        of_water += from_water * length;
        w.guided.push_back((from_water + from_surface) * length);
        w.plain.push_back(plain * clearest * length);
        sum_guided += w.guided.back();
        sum_plain += w.plain.back();
    }
    const double per_band = 1 / static_cast<double>(bands);
    segment.expected = {};
    for (std::size_t b = 0; b < bands; ++b) {
        segment.expected.of_surface += light_of_surface[b] * segment.transmittance[b] * per_band;
        segment.expected.ambient += k_ambient_share * light_of_surface[b] * per_band;
    }
    segment.expected.pixel = sum_guided * per_band + segment.expected.of_surface;
    segment.expected.ambient =
        std::max(segment.expected.ambient, k_min_ambient * segment.expected.pixel);
    segment.paths = {};
    if (segment.expected.pixel > 0) {
        segment.paths.water = std::clamp(
            k_paths_of_share * of_water * per_band / segment.expected.pixel, k_min_paths, 1.0);
        if (has_surface)
            segment.paths.surface =
                std::clamp(k_paths_of_share * reflected / segment.expected.pixel, k_min_paths, 1.0);
    } else {
        // Nothing is known of it, as where only emission lights the scene: by throughput alone.
        segment.expected = {.pixel = 1, .ambient = 1 / k_ambient_beyond, .is_known = false};
    }
    segment.cumulative.clear();
    if (!(sum_plain > 0)) return;
    const double guided_share = sum_guided > 0 ? 1 - k_defensive_share : 0;
    double total = 0;
    for (std::size_t i = 0; i < w.plain.size(); ++i) {
        if (sum_guided > 0) total += guided_share * w.guided[i] / sum_guided;
        total += (1 - guided_share) * w.plain[i] / sum_plain;
        segment.cumulative.push_back(total);
    }
}

void PathTracer::trace_single(const CameraSegment& segment, PathRandom& random,
                              ContributionSink& sink) const {
    const PathTables& tables = choose_tables(random);
    PathState state;
    for (double& value : state.throughput.first(tables.optics.bands())) value = 1;
    state.from_water = true;
    state.vertex = begin_path(segment, sink);
    tables.lamps.estimate_in_scatter(segment.water, state, random, sink);
}

namespace {

// `mean` paths, and what work they were. Whole numbers take no random number: the first covers its
// range the most evenly.
template <class Trace>
double trace_paths(double mean, PathRandom& random, const Trace& trace) {
    double work = 0;
    int count = static_cast<int>(mean);
    const double rest = mean - count;
    if (rest > 0 && random.next() < rest) ++count;
    for (int i = 0; i < count; ++i) work += trace();
    return work;
}

}  // namespace

// A first scattering where the segment's light guides it.
double PathTracer::trace_water_path(const CameraSegment& segment, PathRandom& random,
                                    ContributionSink& sink) const {
    const PathTables& tables = choose_tables(random);
    double u = random.next();
    Workspace& w = workspace_of_thread();
    const Choice interval = choose(segment.cumulative, u);
    const double begin = segment.distances[interval.index];
    const double length = segment.distances[interval.index + 1] - begin;
    if (!(interval.probability > 0)) return 0;
    const double s = begin + u * length;
    const WaterOptics& optics = tables.optics;
    optics.look_up(segment.water, s, w.point);
    optics.find_scattering(w.point);
    CameraSegment::Expected expected = segment.expected;
    expected.pixel /= std::max(1.0, segment.paths.water);
    PathWalk walk(tables, expected, random, sink);
    walk.stay_in_water();
    PathState& state = walk.state();
    optics.transmittances(s, w.point.column, state.throughput);
    for (double& value : state.throughput.first(optics.bands()))
        value *= length / (interval.probability * segment.paths.water);
    state.from_water = true;
    state.distance = s;
    state.vertex = begin_path(segment, sink);
    walk.from_water(segment.water, w.point);
    return walk.work();
}

double PathTracer::trace_water(const CameraSegment& segment, PathRandom& random,
                               ContributionSink& sink) const {
    if (segment.cumulative.empty()) return 0;
    return trace_paths(segment.paths.water, random,
                       [&] { return trace_water_path(segment, random, sink); });
}

void CameraSegment::multiply_paths(const PathCounts& times) {
    const auto multiply = [](double& count, double by) {
        count = std::clamp(count * by, k_min_paths, k_max_paths);
    };
    multiply(paths.water, times.water);
    multiply(paths.lit, times.lit);
    multiply(paths.surface, times.surface);
}

namespace {

class NoContributions final : public ContributionSink {
  public:
    void add(const PathContribution&) override {}
};

PathWalk walk_into_water(const PathTables& tables, const CameraSegment& segment, PathRandom& random,
                         ContributionSink& sink) {
    CameraSegment::Expected expected = segment.expected;
    expected.pixel /= std::max(1.0, segment.paths.lit);
    PathWalk walk(tables, expected, random, sink);
    for (double& value : walk.state().throughput.first(tables.optics.bands()))
        value = 1 / segment.paths.lit;
    walk.state().from_water = true;
    walk.state().vertex = begin_path(segment, sink);
    return walk;
}

}  // namespace

double PathTracer::trace_lit_surfaces(const CameraSegment& segment, PathRandom& random,
                                      ContributionSink& sink) const {
    return trace_paths(segment.paths.lit, random, [&] {
        PathWalk walk = walk_into_water(choose_tables(random), segment, random, sink);
        if (walk.wander(segment.water)) walk.trace_lit_surface();
        return walk.work();
    });
}

double PathTracer::trace_lit_surfaces(const CameraSegment& segment, const IrradianceCache& indirect,
                                      PathRandom& random, ContributionSink& sink) const {
    return trace_paths(segment.paths.lit, random, [&] {
        PathWalk walk = walk_into_water(choose_tables(random), segment, random, sink);
        if (walk.wander(segment.water)) walk.trace_lit_surface(indirect);
        return walk.work();
    });
}

bool PathTracer::find_lit_surface(const CameraSegment& segment, PathRandom& random,
                                  SurfaceSample& sample) const {
    NoContributions sink;
    PathWalk walk = walk_into_water(*tables_.front(), segment, random, sink);
    const WaterSegment* end = walk.wander(segment.water);
    if (end) {
        sample.ray = end->ray;
        sample.hit = end->hit;
    }
    return end != nullptr;
}

double PathTracer::trace_surface(const CameraSegment& segment, PathRandom& random,
                                 ContributionSink& sink) const {
    if (!segment.water.has_hit || segment.water.hit.is_water_surface) return 0;
    return trace_paths(segment.paths.surface, random, [&] {
        const PathTables& tables = choose_tables(random);
        PathWalk walk(tables, segment.expected, random, sink);
        PathState& state = walk.state();
        for (std::size_t b = 0; b < tables.optics.bands(); ++b)
            state.throughput[b] = segment.transmittance[b] / segment.paths.surface;
        state.distance = segment.water.length;
        state.vertex = begin_path(segment, sink);
        walk.from_surface(segment.water);
        return walk.work();
    });
}

void PathTracer::trace_mirrored(const SurfaceSample& sample, PathRandom& random,
                                ContributionSink& sink) const {
    thread_local WaterSegment segment;
    segment.ray = sample.ray;
    segment.length = sample.hit.distance;
    segment.has_hit = true;
    segment.hit = sample.hit;
    const PathTables& tables = choose_tables(random);
    // Something may shine from everywhere, even where there is no lamp.
    PathWalk walk(tables, {.pixel = 1, .ambient = 1}, random, sink);
    PathState& state = walk.state();
    for (double& value : state.throughput.first(tables.optics.bands())) value = 1;
    state.distance = sample.hit.distance;
    walk.mirror(segment);
}

}  // namespace uw
