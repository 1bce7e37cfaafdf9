#include "core/paths/path_tracer.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/fast_exp.h"
#include "core/integrators/integrator.h"
#include "core/integrators/ray_panels.h"
#include "core/paths/choice.h"
#include "core/paths/direction_sampling.h"
#include "core/paths/lamp_gathering.h"

namespace uw {

namespace {

// Paths are not followed beyond this optical depth of the camera ray: e^-20 = 2e-9.
constexpr double k_reach = 20;
// Intervals of uniform water in which the first scattering is uniform; most of them in a plume.
constexpr int k_intervals = 16;
constexpr std::size_t k_most_knots = 64;
// Share of the first scatterings that follow the transmittance alone, so that none is starved.
constexpr double k_defensive_share = 0.1;
// Limits of the probability to go on: below, spared paths would outweigh the rest.
constexpr double k_least_survival = 0.1, k_most_survival = 0.97;
// How far rays begin above the surface they leave, relative to the coordinates and to the last
// segment: above the rounding of single precision, in which surfaces are found.
constexpr double k_offset = 4e-7;

Point3 above(const SurfaceHit& hit) {
    const double scale = std::max({std::abs(hit.position.x), std::abs(hit.position.y),
                                   std::abs(hit.position.z), hit.distance});
    return hit.position + (k_offset * scale) * hit.geometric_normal;
}

}  // namespace

struct PathTracer::Tables {
    WaterOptics optics;
    ScatteringTables scattering;
    LampGathering lamps;
    DirectionSampling directions;
    Spectrum light;  // of all lamps on their axes, or 1 without lamps

    Tables(const LitScene& scene, PathOptions options)
        : optics(scene),
          scattering(*scene.medium),
          lamps(optics, scattering, std::move(options.deep_shadows)),
          directions(optics, scattering) {
        for (const Lamp& lamp : *scene.lamps) light += lamp.axis_intensity();
        if (scene.lamps->empty())
            for (std::size_t b = 0; b < optics.bands(); ++b) light[b] = 1;
    }
};

/// One path, from its first vertex to its end.
class PathTracer::Walk {
  public:
    Walk(const Tables& tables, double own_light, PathRandom& random, PathTerms& terms)
        : tables_(tables), own_light_(own_light), random_(random), terms_(terms) {}

    PathState& state() { return state_; }

    /// Scatters at a point of `segment`; `scattering_per_metre`: over the density of the point.
    void from_water(const WaterSegment& segment, WaterPoint& point);
    void from_surface(const WaterSegment& segment);

  private:
    void follow(Ray ray);
    // Each moves to the next vertex; false if the path ends.
    bool advance(std::optional<Ray>& next);
    bool reflect_at_end(double probability, std::optional<Ray>& next);
    bool scatter_on_the_way(double u, std::optional<Ray>& next);
    bool survives(const Point3& x, double glow_share);

    const Tables& tables_;
    double own_light_;
    PathRandom& random_;
    PathTerms& terms_;
    PathState state_;
};

namespace {

/// Per thread: paths do not allocate.
struct Workspace {
    WaterSegment segment;
    WaterPoint point, first_point;
    std::vector<double> transmittance, c, glow, shares, response, cumulative, guided, plain;
};

Workspace& workspace_of_thread() {
    thread_local Workspace workspace;
    return workspace;
}

}  // namespace

void PathTracer::Walk::from_water(const WaterSegment& segment, WaterPoint& point) {
    const Point3 x = segment.ray.at(point.distance);
    ++state_.scatterings;
    const Vector3 direction =
        tables_.directions.scatter(x, segment.ray.direction, point, random_, state_.throughput);
    follow({x, direction});
}

void PathTracer::Walk::from_surface(const WaterSegment& segment) {
    ++state_.reflections;
    const std::optional<Vector3> direction =
        tables_.directions.reflect(segment, random_, state_.throughput);
    if (direction) follow({above(segment.hit), *direction});
}

void PathTracer::Walk::follow(Ray ray) {
    Workspace& w = workspace_of_thread();
    const WaterOptics& optics = tables_.optics;
    const std::size_t bands = optics.bands();
    w.transmittance.resize(bands);
    std::optional<Ray> next = ray;
    while (next) {
        optics.trace(*next, w.segment);
        tables_.lamps.gather_from_water(w.segment, state_, random_, terms_);
        if (w.segment.has_hit) {
            optics.look_up(w.segment, w.segment.length, w.point);
            optics.transmittances(w.segment.length, w.point.column, w.transmittance);
            tables_.lamps.gather_from_surface(w.segment, w.transmittance, state_, random_, terms_);
        } else {
            std::ranges::fill(w.transmittance, 0.0);  // no light returns from k_far
        }
        next.reset();
        if (!advance(next)) return;
    }
}

bool PathTracer::Walk::advance(std::optional<Ray>& next) {
    Workspace& w = workspace_of_thread();
    const WaterOptics& optics = tables_.optics;
    const std::size_t bands = optics.bands();
    const double u = random_.next();
    // Each band has a share in a density that serves all of them.
    w.shares.resize(bands);
    double all = 0, to_surface = 0;
    for (std::size_t b = 0; b < bands; ++b) {
        w.shares[b] = state_.throughput[b] * tables_.light[b];
        all += w.shares[b];
        to_surface += w.shares[b] * w.transmittance[b];
    }
    if (!(all > 0)) return false;
    for (double& share : w.shares) share /= all;
    to_surface /= all;
    if (u < to_surface) return w.segment.has_hit && reflect_at_end(to_surface, next);
    return scatter_on_the_way((u - to_surface) / (1 - to_surface), next);
}

bool PathTracer::Walk::reflect_at_end(double probability, std::optional<Ray>& next) {
    Workspace& w = workspace_of_thread();
    const SurfaceHit& hit = w.segment.hit;
    Spectrum& throughput = state_.throughput;
    const std::size_t bands = tables_.optics.bands();
    for (std::size_t b = 0; b < bands; ++b) throughput[b] *= w.transmittance[b] / probability;
    w.response.resize(bands);
    for (std::size_t b = 0; b < bands; ++b)
        w.response[b] = throughput[b] * (hit.has_material ? 1.0 : hit.reflectance[b]);
    tables_.optics.find_scattering(w.point);
    if (!survives(hit.position, 0.5 * std::numbers::inv_pi)) return false;
    ++state_.reflections;
    const std::optional<Vector3> direction =
        tables_.directions.reflect(w.segment, random_, throughput);
    if (direction) next = Ray{above(hit), *direction};
    return next.has_value();
}

bool PathTracer::Walk::scatter_on_the_way(double u, std::optional<Ray>& next) {
    Workspace& w = workspace_of_thread();
    const WaterOptics& optics = tables_.optics;
    Spectrum& throughput = state_.throughput;
    const std::size_t bands = optics.bands();
    w.cumulative.resize(bands);
    double total = 0;
    for (std::size_t b = 0; b < bands; ++b) {
        total += w.shares[b] * (1 - w.transmittance[b]);
        w.cumulative[b] = total;
    }
    if (!(total > 0)) return false;
    const std::size_t band = choose(w.cumulative, u).index;
    const double depth = -std::log1p(-u * (1 - w.transmittance[band]));
    const double s = optics.distance_at_depth(w.segment, band, depth);
    if (!(s < w.segment.length)) return false;  // beyond k_far, or by rounding
    optics.look_up(w.segment, s, w.point);
    optics.find_scattering(w.point);
    w.c.resize(bands);
    w.response.resize(bands);
    optics.attenuations(w.point, w.c);
    optics.transmittances(s, w.point.column, w.transmittance);
    double density = 0;
    for (std::size_t b = 0; b < bands; ++b) density += w.shares[b] * w.c[b] * w.transmittance[b];
    if (!(density > 0)) return false;
    for (std::size_t b = 0; b < bands; ++b) {
        throughput[b] *= w.transmittance[b] / density;
        double scattering = 0;
        for (const Spectrum& own : w.point.scattering) scattering += own[b];
        w.response[b] = throughput[b] * scattering;
    }
    const Point3 x = w.segment.ray.at(s);
    if (!survives(x, 0.25 * std::numbers::inv_pi)) return false;
    ++state_.scatterings;
    const Vector3 direction =
        tables_.directions.scatter(x, w.segment.ray.direction, w.point, random_, throughput);
    next = Ray{x, direction};
    return true;
}

// Russian roulette by what the path may still bring: its response (albedo times throughput) times
// the light around its vertex. `glow_share`: of the glow per scattering coefficient.
bool PathTracer::Walk::survives(const Point3& x, double glow_share) {
    Workspace& w = workspace_of_thread();
    const double of_survival = random_.next();
    const std::size_t bands = tables_.optics.bands();
    w.glow.resize(bands);
    tables_.directions.glow(x, w.glow);
    double expected = 0, responds = 0;
    for (std::size_t b = 0; b < bands; ++b) {
        double scattering = 0;
        for (const Spectrum& own : w.point.scattering) scattering += own[b];
        expected += w.response[b] * (glow_share * scattering * w.glow[b] + own_light_);
        responds += w.response[b];
    }
    if (!(responds > 0)) return false;
    const double ratio = own_light_ > 0 ? expected / (static_cast<double>(bands) * own_light_)
                                        : responds / static_cast<double>(bands);
    const double survival = std::clamp(ratio, k_least_survival, k_most_survival);
    if (of_survival >= survival) return false;
    for (double& value : state_.throughput.first(bands)) value /= survival;
    return true;
}

PathTracer::PathTracer(const LitScene& scene, PathOptions options)
    : tables_(std::make_unique<Tables>(scene, std::move(options))) {}

PathTracer::~PathTracer() = default;

void PathTracer::begin(const Ray& ray, const SurfaceHit* hit, std::span<const double> surface_light,
                       CameraSegment& segment) const {
    Workspace& w = workspace_of_thread();
    const WaterOptics& optics = tables_->optics;
    WaterSegment& water = segment.water;
    optics.set(ray, hit, water);
    optics.look_up(water, water.length, w.point);
    segment.transmittance.assign(optics.bands(), 0.0);
    if (hit) optics.transmittances(water.length, w.point.column, segment.transmittance);
    place_intervals(segment);
    weigh_intervals(surface_light, segment);
}

// The ends of the intervals: at equal steps of the transmittance, at the lamp's nearest points, and
// at knots of the concentrations.
void PathTracer::place_intervals(CameraSegment& segment) const {
    const WaterOptics& optics = tables_->optics;
    const WaterSegment& water = segment.water;
    std::vector<double>& s = segment.distances;
    const double c = optics.attenuation().uniform.first(optics.bands()).empty()
                         ? 0.0
                         : optics.attenuation().uniform.least(optics.bands());
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
    const double whole = -std::expm1(-c * reach);
    for (int i = 1; i < k_intervals; ++i) {
        const double share = static_cast<double>(i) / k_intervals;
        s.push_back(c > 0 ? -std::log1p(-share * whole) / c : share * reach);
    }
    for (const Lamp& lamp : *optics.scene().lamps) {
        const LampPassage passage(water.ray, lamp.position());
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
    const WaterOptics& optics = tables_->optics;
    const std::size_t bands = optics.bands();
    const WaterSegment& water = segment.water;
    const std::vector<double>& s = segment.distances;
    w.glow.resize(bands);
    w.transmittance.resize(bands);
    w.guided.clear();
    w.plain.clear();
    double own = 0, sum_guided = 0, sum_plain = 0;
    for (std::size_t i = 0; i + 1 < s.size(); ++i) {
        const double length = s[i + 1] - s[i], middle = 0.5 * (s[i] + s[i + 1]);
        optics.look_up(water, middle, w.point);
        optics.find_scattering(w.point);
        optics.transmittances(middle, w.point.column, w.transmittance);
        tables_->directions.glow(water.ray.at(middle), w.glow);
        double guided = 0, plain = 0;
        for (std::size_t b = 0; b < bands; ++b) {
            double scattering = 0;
            for (const Spectrum& m : w.point.scattering) scattering += m[b];
            const double seen = scattering * w.transmittance[b];
            double light = 0.25 * std::numbers::inv_pi * scattering * w.glow[b];
            // The lit surface, seen through the water by a small detour.
            if (!surface_light.empty() && w.transmittance[b] > 0)
                light += surface_light[b] * segment.transmittance[b] / w.transmittance[b];
            guided += seen * light;
            plain += seen * tables_->light[b];
        }
        w.guided.push_back(guided * length);
        w.plain.push_back(plain * length);
        sum_guided += w.guided.back();
        sum_plain += w.plain.back();
    }
    own = sum_guided;
    for (std::size_t b = 0; b < surface_light.size(); ++b)
        own += surface_light[b] * segment.transmittance[b];
    segment.own_light = own / static_cast<double>(bands);
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
    PathState state;
    for (double& value : state.throughput.first(tables_->optics.bands())) value = 1;
    state.from_water = true;
    tables_->lamps.gather_from_water(segment.water, state, random, terms);
}

void PathTracer::trace_water(const CameraSegment& segment, PathRandom& random,
                             PathTerms& terms) const {
    double u = random.next();
    if (segment.cumulative.empty()) return;
    Workspace& w = workspace_of_thread();
    const Choice interval = choose(segment.cumulative, u);
    const double begin = segment.distances[interval.index];
    const double length = segment.distances[interval.index + 1] - begin;
    if (!(interval.probability > 0)) return;
    const double s = begin + u * length;
    const WaterOptics& optics = tables_->optics;
    optics.look_up(segment.water, s, w.first_point);
    optics.find_scattering(w.first_point);
    Walk walk(*tables_, segment.own_light, random, terms);
    PathState& state = walk.state();
    const std::span<double> throughput = state.throughput.first(optics.bands());
    optics.transmittances(s, w.first_point.column, throughput);
    for (double& value : throughput) value *= length / interval.probability;
    state.from_water = true;
    state.distance = s;
    walk.from_water(segment.water, w.first_point);
}

void PathTracer::trace_surface(const CameraSegment& segment, PathRandom& random,
                               PathTerms& terms) const {
    if (!segment.water.has_hit) return;
    Walk walk(*tables_, segment.own_light, random, terms);
    PathState& state = walk.state();
    std::ranges::copy(segment.transmittance, state.throughput.begin());
    state.distance = segment.water.length;
    walk.from_surface(segment.water);
}

}  // namespace uw
