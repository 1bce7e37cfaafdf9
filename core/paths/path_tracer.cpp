#include "core/paths/path_tracer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/error.h"
#include "core/base/numerics.h"
#include "core/light/lamp.h"
#include "core/light/ray_panels.h"
#include "core/paths/indirect_light.h"
#include "core/paths/lamp_gathering.h"
#include "core/paths/path_tables.h"
#include "core/paths/path_vertex.h"
#include "core/paths/path_walk.h"
#include "core/paths/scattering_tables.h"

namespace uw {

namespace {

// The ambient light is at least this relative to the pixel's.
constexpr double k_least_ambient = 0.05;
// Paths are not followed beyond this optical depth of the camera ray: e^-20 = 2e-9.
constexpr double k_reach = 20;
// Intervals of uniform water in which the first scattering is uniform; most of them in a plume.
constexpr int k_views_of_ray = 8;
constexpr double k_far_begin = 1.5, k_far_step = 0.5;
constexpr std::size_t k_most_knots = 64;
constexpr std::size_t k_most_guiding_bands = 4;
// Share of the first scatterings that follow the transmittance alone, so that none is starved.
constexpr double k_defensive_share = 0.1;

/// Per thread: preparing a ray does not allocate.
struct Workspace {
    WaterPoint point;
    std::vector<LampPassage> passages;  // of the lamps
    std::vector<LampGlow::Spread> spreads;
    std::vector<double> guided, plain;
};

Workspace& workspace_of_thread() {
    thread_local Workspace workspace;
    return workspace;
}

}  // namespace

PathTracer::PathTracer(const LitScene& scene, const PathOptions& options)
    : scattering_(std::make_unique<ScatteringTables>(*scene.medium)),
      views_(lamp_views(*scene.emitters)) {
    for (const LampView& view : views_) {
        LitScene seen = scene;
        seen.emitters = &view.lamps;
        std::vector<std::shared_ptr<const DeepShadow>> deep_shadows;
        if (!options.deep_shadows.empty())
            for (const std::size_t emitter : view.emitters)
                deep_shadows.push_back(options.deep_shadows[emitter]);
        tables_.push_back(
            std::make_unique<PathTables>(seen, *scattering_, std::move(deep_shadows)));
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
        const std::size_t stride = 1 + profile.s.size() / k_most_knots;
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

void PathTracer::weigh_intervals(std::span<const double> surface_light,
                                 CameraSegment& segment) const {
    Workspace& w = workspace_of_thread();
    const WaterOptics& optics = tables_.front()->optics;
    const std::size_t bands = optics.bands();
    const WaterSegment& water = segment.water;
    const std::vector<double>& s = segment.distances;
    const std::vector<Lamp>& lamps = *optics.scene().emitters;
    const AttenuationTable& attenuation = optics.attenuation();
    // A few of the bands, evenly spread, stand for all.
    const std::size_t stride = (bands + k_most_guiding_bands - 1) / k_most_guiding_bands;
    w.guided.clear();
    w.plain.clear();
    double sum_guided = 0, sum_plain = 0;
    for (std::size_t i = 0; i + 1 < s.size(); ++i) {
        const double length = s[i + 1] - s[i], middle = 0.5 * (s[i] + s[i + 1]);
        optics.look_up(water, middle, w.point);
        optics.find_scattering(w.point);
        w.spreads.clear();
        for (std::size_t j = 0; j < lamps.size(); ++j)
            w.spreads.push_back(
                tables_.front()->glow.spread(j, w.passages[j], middle, water.ray.at(middle)));
        double guided = 0, plain = 0;
        for (std::size_t b = stride / 2; b < bands; b += stride) {
            double scattering = 0;
            for (const Spectrum& m : w.point.scattering) scattering += m[b];
            const double depth = attenuation.optical_depth(b, middle, w.point.column);
            double light = 0;
            for (std::size_t j = 0; j < lamps.size(); ++j)
                light += w.spreads[j].relative * lamps[j].axis_intensity()[b] *
                         exp_of_minus(depth + attenuation.uniform[b] * w.spreads[j].radius);
            light *= scattering;
            // The lit surface, seen through the water by a small detour.
            if (!surface_light.empty()) light += surface_light[b] * segment.transmittance[b];
            guided += scattering * light;
        }
        for (const Spectrum& m : w.point.scattering)
            for (const double b : m.first(bands)) plain += b;
        plain *=
            exp_of_minus(attenuation.optical_depth(optics.clearest_band(), middle, w.point.column));
        w.guided.push_back(guided * length);
        w.plain.push_back(plain * length);
        sum_guided += w.guided.back();
        sum_plain += w.plain.back();
    }
    segment.light = {sum_guided * static_cast<double>(stride), 0};
    for (std::size_t b = 0; b < surface_light.size(); ++b) {
        segment.light.own += surface_light[b] * segment.transmittance[b];
        segment.light.ambient += surface_light[b];
    }
    segment.light.own /= static_cast<double>(bands);
    segment.light.ambient *= k_ambient_share / static_cast<double>(bands);
    segment.light.ambient = std::max(segment.light.ambient, k_least_ambient * segment.light.own);
    // Nothing known of it, as where only emission lights the scene: by throughput alone.
    if (!(segment.light.own > 0)) segment.light = {1, 1};
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
                              PathTerms& terms) const {
    const PathTables& tables = choose_tables(random);
    PathState state;
    for (double& value : state.throughput.first(tables.optics.bands())) value = 1;
    state.from_water = true;
    tables.lamps.gather_from_water(segment.water, {}, state, random, terms);
}

// A first scattering where the segment's light guides it.
void PathTracer::scatter_first(const CameraSegment& segment, PathRandom& random, PathTerms& terms,
                               bool stays_in_water) const {
    const PathTables& tables = choose_tables(random);
    double u = random.next();
    if (segment.cumulative.empty()) return;
    Workspace& w = workspace_of_thread();
    const Choice interval = choose(segment.cumulative, u);
    const double begin = segment.distances[interval.index];
    const double length = segment.distances[interval.index + 1] - begin;
    if (!(interval.probability > 0)) return;
    const double s = begin + u * length;
    const WaterOptics& optics = tables.optics;
    optics.look_up(segment.water, s, w.point);
    optics.find_scattering(w.point);
    PathWalk walk(tables, segment.light, random, terms);
    if (stays_in_water) walk.stay_in_water();
    PathState& state = walk.state();
    optics.transmittances(s, w.point.column, state.throughput);
    for (double& value : state.throughput.first(optics.bands()))
        value *= length / interval.probability;
    state.from_water = true;
    state.distance = s;
    walk.from_water(segment.water, w.point);
}

void PathTracer::trace_water(const CameraSegment& segment, PathRandom& random,
                             PathTerms& terms) const {
    scatter_first(segment, random, terms, false);
}

void PathTracer::trace_water_alone(const CameraSegment& segment, PathRandom& random,
                                   PathTerms& terms) const {
    scatter_first(segment, random, terms, true);
}

namespace {

class NoTerms final : public PathTerms {
  public:
    void add(const PathTerm&) override {}
};

PathWalk walk_into_water(const PathTables& tables, const CameraSegment& segment, PathRandom& random,
                         PathTerms& terms) {
    PathWalk walk(tables, segment.light, random, terms);
    for (double& value : walk.state().throughput.first(tables.optics.bands())) value = 1;
    walk.state().from_water = true;
    return walk;
}

}  // namespace

void PathTracer::trace_lit_surfaces(const CameraSegment& segment, const IndirectLight& indirect,
                                    PathRandom& random, PathTerms& terms) const {
    PathWalk walk = walk_into_water(choose_tables(random), segment, random, terms);
    if (walk.wander(segment.water)) walk.gather_lit_surface(indirect);
}

bool PathTracer::find_lit_surface(const CameraSegment& segment, PathRandom& random,
                                  SurfaceSample& sample) const {
    NoTerms terms;
    PathWalk walk = walk_into_water(*tables_.front(), segment, random, terms);
    const WaterSegment* end = walk.wander(segment.water);
    if (end) {
        sample.ray = end->ray;
        sample.hit = end->hit;
    }
    return end != nullptr;
}

void PathTracer::trace_surface(const CameraSegment& segment, PathRandom& random,
                               PathTerms& terms) const {
    if (!segment.water.has_hit) return;
    PathWalk walk(choose_tables(random), segment.light, random, terms);
    PathState& state = walk.state();
    std::ranges::copy(segment.transmittance, state.throughput.begin());
    state.distance = segment.water.length;
    walk.from_surface(segment.water);
}

void PathTracer::trace_mirrored(const SurfaceSample& sample, PathRandom& random,
                                PathTerms& terms) const {
    thread_local WaterSegment segment;
    segment.ray = sample.ray;
    segment.length = sample.hit.distance;
    segment.has_hit = true;
    segment.hit = sample.hit;
    const PathTables& tables = choose_tables(random);
    PathWalk walk(tables, {}, random, terms);
    PathState& state = walk.state();
    for (double& value : state.throughput.first(tables.optics.bands())) value = 1;
    state.distance = sample.hit.distance;
    walk.mirror(segment);
}

}  // namespace uw
