#include "core/paths/path_tracer.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/base/error.h"
#include "core/base/numerics.h"
#include "core/light/lamp.h"
#include "core/light/ray_panels.h"
#include "core/paths/indirect_light.h"
#include "core/paths/lamp_gathering.h"
#include "core/paths/path_vertex.h"
#include "core/paths/scattering_tables.h"

namespace uw {

/// A scene's lamps as a light path sees them: each as one point, whatever its extent. The mean over
/// all views is the light of the lamps, so that a path that chooses one at random costs what it
/// does among point lamps.
struct LampView {
    std::vector<Lamp> lamps;            // one per lamp
    std::vector<std::size_t> emitters;  // which of the scene's each of them is
};

/// What all paths through a scene look up that see its lamps alike (LampView).
struct PathTables {
    WaterOptics optics;
    const ScatteringTables& scattering;
    LampGathering lamps;
    LampGlow glow;
    VertexTables vertices;
    Spectrum light;   // of all lamps on their axes, or 1 where there is none
    Spectrum albedo;  // the greatest of all the water may hold, at least 0.1: guides paths

    /// `scene`: with one emitter per lamp. `deep_shadows`: as LampGathering takes them. What is
    /// referred to must outlive this object.
    PathTables(const LitScene& scene, const ScatteringTables& tables,
               std::vector<std::shared_ptr<const DeepShadow>> deep_shadows)
        : optics(scene),
          scattering(tables),
          lamps(optics, scattering, std::move(deep_shadows)),
          glow(optics, scattering),
          vertices{&optics, &scattering, &glow} {
        for (const Lamp& lamp : *scene.emitters) light += lamp.axis_intensity();
        for (std::size_t b = 0; b < optics.bands(); ++b) {
            const auto include = [&](const OpticalCoefficients& coefficients) {
                const double c = coefficients.attenuation(b);
                if (c > 0) albedo[b] = std::max(albedo[b], coefficients.total_scattering()[b] / c);
            };
            include(scene.medium->uniform);
            for (const Constituent& constituent : scene.medium->constituents)
                include(constituent.per_unit);
            albedo[b] = std::max(albedo[b], 0.1);
        }
        // Without any, surfaces may shine.
        const std::span<double> of_bands = light.first(optics.bands());
        if (std::ranges::all_of(of_bands, [](double value) { return value == 0; }))
            std::ranges::fill(of_bands, 1.0);
    }
};

namespace {

// The indices of each lamp's first emitter, and of the one after the last.
std::vector<std::size_t> first_emitters(const std::vector<Lamp>& emitters) {
    std::vector<std::size_t> first;
    for (std::size_t i = 0; i < emitters.size(); ++i)
        if (emitters[i].index() == first.size()) first.push_back(i);
    first.push_back(emitters.size());
    return first;
}

/// As many views as the lamp with most emitters has, and one without lamps. `emitters`: as
/// LitScene::emitters.
std::vector<LampView> lamp_views(const std::vector<Lamp>& emitters) {
    const std::vector<std::size_t> first = first_emitters(emitters);
    std::size_t most = 1;
    for (std::size_t j = 0; j + 1 < first.size(); ++j)
        most = std::max(most, first[j + 1] - first[j]);
    std::vector<LampView> views(most);
    for (std::size_t j = 0; j + 1 < first.size(); ++j) {
        const std::size_t count = first[j + 1] - first[j];
        for (std::size_t e = 0; e < count; ++e) {
            // Evenly among the views, each emitter as bright as it is in few of them.
            const std::size_t begin = e * most / count, end = (e + 1) * most / count;
            const double weight = static_cast<double>(most) / static_cast<double>(end - begin);
            const Lamp& emitter = emitters[first[j] + e];
            for (std::size_t view = begin; view < end; ++view) {
                views[view].lamps.push_back(count == 1 ? emitter : emitter.brightened(weight));
                views[view].emitters.push_back(first[j] + e);
            }
        }
    }
    return views;
}

// The probability to go on for what may still arrive, relative to the light of the path's pixel,
// and its limits: below, spared paths would outweigh the rest.
constexpr double k_thoroughness = 3;
constexpr double k_least_survival = 0.25, k_least_lobe_survival = 0.2, k_most_survival = 0.97;
// Where much more may arrive than the light of the path's pixel, as in front of a surface close to
// a lamp, a path splits: into these many branches relative to it, each with its share of the light.
// In all it has no more than the limit, or the paths of a black pixel might never end.
constexpr double k_splitting = 0.3, k_most_branches = 16;
// The least reflectance that a surface counts with when paths head for it.
constexpr double k_least_reflectance = 0.1;
// The light that a path may meet anywhere, relative to that of the surface its pixel sees, and at
// least relative to the pixel's.
constexpr double k_ambient_share = 0.5, k_least_ambient = 0.05;
// How far rays begin above the surface they leave, relative to the coordinates and to the last
// segment: above the rounding of single precision, in which surfaces are found.
constexpr double k_offset = 4e-7;

Point3 above(const SurfaceHit& hit) {
    const double scale = std::max({std::abs(hit.position.x), std::abs(hit.position.y),
                                   std::abs(hit.position.z), hit.distance});
    return hit.position + (k_offset * scale) * hit.geometric_normal;
}

/// One path, from its first vertex to its end.
class PathWalk {
  public:
    PathWalk(const PathTables& tables, const CameraSegment::Light& light, PathRandom& random,
             PathTerms& terms)
        : tables_(tables), light_(light), random_(random), terms_(terms) {}

    PathState& state() { return state_; }
    /// Ends the path at surfaces and leaves out what they emit and reflect.
    void stay_in_water() { stays_in_water_ = true; }

    /// Begins with a scattering at `point` of `segment`, or with a reflection at its end.
    void from_water(const WaterSegment& segment, const WaterPoint& point);
    void from_surface(const WaterSegment& segment);
    /// What the surface at the end of `segment` reflects of light that was scattered or reflected
    /// once before, and no more.
    void mirror(const WaterSegment& segment);
    /// Is scattered on `segment`, and on by the phase function alone until it meets a surface,
    /// which is the end of this; null if it meets none.
    const WaterSegment* wander(const WaterSegment& segment);
    /// The light of the surface at which it has ended.
    void gather_lit_surface(const IndirectLight& indirect);

  private:
    struct Continuation;
    struct Workspace;

    static Workspace& workspace_of_thread();

    // Gathers the light that arrives at the workspace's vertex, and finds the path's next segment;
    // false if it ends there, as it does anyhow if this `is_last`.
    bool leave(const Point3& origin, bool is_last = false);
    void gather_along(const DrawnLobe& lobe, const Continuation& along, const Point3& origin);
    void continuation(const Vector3& direction, Continuation& along) const;
    double survival(const Continuation& along, double least) const;
    double branches(double value, double by_own, double by_lobe) const;
    void find_emission(const Spectrum& throughput);
    PathState continued(const Continuation& along, double survival) const;
    void trace(const Ray& ray);
    void find_transmittance();  // of the segment
    void follow(bool goes_on);
    // Each moves to the next vertex and on from there; false if the path ends.
    bool advance();
    bool reflect_at_end(double probability);
    bool scatter_on_the_way(double u);
    // The distance of the next scattering on the segment, by w.shares of what the bands lose on the
    // way to its end; its length if there is none.
    double draw_distance(double u) const;
    // Moves there; the shares are relative to all that may happen on the segment. False if the
    // water does nothing there.
    bool go_to(double distance);
    // Whether there is a surface before; if so, it ends the segment.
    bool meets_surface_before(double distance);

    const PathTables& tables_;
    CameraSegment::Light light_;
    PathRandom& random_;
    PathTerms& terms_;
    PathState state_;
    bool stays_in_water_ = false;
};

/// A direction in which a path may go on from a vertex.
struct PathWalk::Continuation {
    Spectrum response;                   // PathVertex::respond
    double own_density = 0;              // of PathVertex::draw
    std::vector<double> lobe_densities;  // by lamp, of PathVertex::draw_lobe
    double density = 0;                  // the sum of them
    double value = 0;  // what may still arrive at the camera from there [W m^-2 sr^-1]
};

/// Per thread: paths do not allocate.
struct PathWalk::Workspace {
    /// A branch of a path that has yet to be followed.
    struct Pending {
        PathState state;
        Ray ray;
    };

    WaterSegment segment, lobe_segment;
    WaterPoint point;
    Spectrum transmittance;
    std::vector<double> c, shares, cumulative;
    PathVertex vertex;
    Continuation along_own, along_lobe;
    std::vector<double> chosen_lamp;  // a weight for each
    std::vector<double> indirect;     // by lamp and band
    std::vector<Pending> pending;
};

PathWalk::Workspace& PathWalk::workspace_of_thread() {
    thread_local Workspace workspace;
    return workspace;
}

void PathWalk::from_water(const WaterSegment& segment, const WaterPoint& point) {
    PathVertex& vertex = workspace_of_thread().vertex;
    const Point3 x = segment.ray.at(point.distance);
    vertex.scatter(tables_.vertices, x, segment.ray.direction, point, state_.throughput);
    ++state_.scatterings;
    follow(leave(x));
}

void PathWalk::from_surface(const WaterSegment& segment) {
    PathVertex& vertex = workspace_of_thread().vertex;
    vertex.reflect(tables_.vertices, segment, state_.throughput);
    ++state_.reflections;
    follow(leave(above(segment.hit)));
}

void PathWalk::mirror(const WaterSegment& segment) {
    PathVertex& vertex = workspace_of_thread().vertex;
    vertex.reflect(tables_.vertices, segment, state_.throughput);
    ++state_.reflections;
    leave(above(segment.hit), true);
}

// Gathers along a direction of the vertex's own and along one around a lamp, weighted against each
// other by the balance heuristic (Veach and Guibas 1995). The path may go on along both, each with
// a probability in proportion to what may still arrive from there: drawing one of them each time
// would let throughputs grow from vertex to vertex, and taking none of the second kind would miss
// the paths that head for the bright water at a lamp.
bool PathWalk::leave(const Point3& origin, bool is_last) {
    Workspace& w = workspace_of_thread();
    const PathVertex& vertex = w.vertex;
    const std::size_t bands = tables_.optics.bands();
    const std::optional<DrawnLobe> lobe = vertex.draw_lobe(random_);
    const std::optional<DrawnDirection> own = vertex.draw(random_);
    const double of_lobe = random_.next(), of_own = random_.next();
    if (lobe) continuation(lobe->direction, w.along_lobe);
    if (own) continuation(own->direction, w.along_own);
    // The probabilities to go on. Less than one branch does on average, or paths might never end.
    double by_lobe = lobe && !is_last ? survival(w.along_lobe, k_least_lobe_survival) : 0;
    double by_own = own && !is_last ? survival(w.along_own, k_least_survival) : 0;
    const double excess = (by_lobe + by_own) / k_most_survival;
    if (excess > 1) {
        by_lobe /= excess;
        by_own /= excess;
    }
    if (lobe) {
        gather_along(*lobe, w.along_lobe, origin);
        if (of_lobe < by_lobe)
            w.pending.push_back({continued(w.along_lobe, by_lobe), {origin, lobe->direction}});
    }
    if (!own) return false;
    PathState state = state_;
    for (std::size_t b = 0; b < bands; ++b)
        state.throughput[b] *= w.along_own.response[b] / own->density;
    for (double& weight : w.along_own.lobe_densities)
        weight = own->density / (own->density + weight);
    trace({origin, own->direction});
    tables_.lamps.gather_from_water(w.segment, w.along_own.lobe_densities, state, random_, terms_);
    double seen = 0;
    if (w.segment.has_hit && !stays_in_water_)
        seen =
            tables_.lamps.gather_from_surface(w.segment, w.transmittance, state, random_, terms_);
    if (by_own > 0) by_own = branches(w.along_own.value + seen, by_own, by_lobe);
    if (seen > 0 && w.segment.hit.has_material) find_emission(state.throughput);
    if (of_own >= by_own) return false;
    state_ = continued(w.along_own, by_own);
    state_.branches *= std::max(1.0, by_own);
    for (double n = of_own + 1; n < by_own; ++n)
        w.pending.push_back({state_, {origin, own->direction}});
    return true;
}

// The single-scattered light of a lamp around which a direction was drawn.
void PathWalk::gather_along(const DrawnLobe& lobe, const Continuation& along,
                            const Point3& origin) {
    Workspace& w = workspace_of_thread();
    PathState state = state_;
    const double density = lobe.density + along.own_density;
    for (std::size_t b = 0; b < tables_.optics.bands(); ++b)
        state.throughput[b] *= along.response[b] / density;
    w.chosen_lamp.assign(along.lobe_densities.size(), 0.0);
    w.chosen_lamp[lobe.lamp] = 1;
    tables_.optics.trace_briefly({origin, lobe.direction}, w.lobe_segment);
    tables_.lamps.gather_from_water(w.lobe_segment, w.chosen_lamp, state, random_, terms_);
}

void PathWalk::continuation(const Vector3& direction, Continuation& along) const {
    const PathVertex& vertex = workspace_of_thread().vertex;
    vertex.lobe_densities(direction, along.lobe_densities);
    vertex.respond(direction, along.response);
    along.own_density = along.density = vertex.density(direction);
    for (const double of_lamp : along.lobe_densities) along.density += of_lamp;
    along.value = 0;
    double responds = 0, all = 0;
    for (std::size_t b = 0; b < tables_.optics.bands(); ++b) {
        responds += state_.throughput[b] * along.response[b];
        all += state_.throughput[b];
    }
    if (!(along.density > 0) || !(responds > 0)) return;
    const double light = vertex.expected_light(direction) / all + light_.ambient;
    along.value = responds / along.density * light / static_cast<double>(tables_.optics.bands());
}

// Russian roulette by what may still arrive, relative to the light of the path's pixel.
double PathWalk::survival(const Continuation& along, double least) const {
    if (!(along.value > 0)) return 0;
    return std::clamp(k_thoroughness * along.value / light_.own, least, k_most_survival);
}

// How many branches go on, on average, along its own direction, now that the surface at its end has
// been seen: a bright one means more light beside it. `by_own` did before.
double PathWalk::branches(double value, double by_own, double by_lobe) const {
    const double relative = value / light_.own;
    const double split = std::min(k_splitting * relative, k_most_branches / state_.branches);
    if (split > 1) return split;
    return std::max(by_own, std::min(k_thoroughness * relative, k_most_survival - by_lobe));
}

// What surfaces emit is not in the light that paths are measured by until one has seen it. Where
// lamps are faint beside it, paths would split for ever, and go on by chance alone.
void PathWalk::find_emission(const Spectrum& throughput) {
    const std::size_t bands = tables_.optics.bands();
    const SurfaceMaterial material =
        tables_.optics.scene().surfaces->material(workspace_of_thread().segment.hit);
    double light = 0, emission = 0;
    for (std::size_t b = 0; b < bands; ++b) {
        light += throughput[b] * material.emission[b];
        emission += material.emission[b];
    }
    light_.own = std::max(light_.own, light / static_cast<double>(bands));
    light_.ambient =
        std::max(light_.ambient, k_ambient_share * emission / static_cast<double>(bands));
}

PathState PathWalk::continued(const Continuation& along, double survival) const {
    PathState state = state_;
    for (std::size_t b = 0; b < tables_.optics.bands(); ++b)
        state.throughput[b] *= along.response[b] / (along.density * survival);
    return state;
}

void PathWalk::trace(const Ray& ray) {
    tables_.optics.trace(ray, workspace_of_thread().segment);
    find_transmittance();
}

void PathWalk::find_transmittance() {
    Workspace& w = workspace_of_thread();
    const WaterOptics& optics = tables_.optics;
    if (!w.segment.has_hit) {
        std::ranges::fill(w.transmittance.first(optics.bands()), 0.0);  // none returns from k_far
        return;
    }
    optics.look_up(w.segment, w.segment.length, w.point);
    optics.transmittances(w.segment.length, w.point.column, w.transmittance);
}

void PathWalk::follow(bool goes_on) {
    Workspace& w = workspace_of_thread();
    while (goes_on) goes_on = advance();
    while (!w.pending.empty()) {
        const Workspace::Pending pending = w.pending.back();
        w.pending.pop_back();
        state_ = pending.state;
        trace(pending.ray);
        do {
            goes_on = advance();
        } while (goes_on);
    }
}

bool PathWalk::advance() {
    Workspace& w = workspace_of_thread();
    const std::size_t bands = tables_.optics.bands();
    const double u = random_.next();
    // Each band has a share in a density that serves all of them.
    w.shares.resize(bands);
    double in_water = 0, at_surface = 0;
    for (std::size_t b = 0; b < bands; ++b) {
        const double share = state_.throughput[b] * tables_.light[b];
        w.shares[b] = share * tables_.albedo[b];
        in_water += w.shares[b] * (1 - w.transmittance[b]);
        if (w.segment.has_hit && !stays_in_water_)
            at_surface += share * w.transmittance[b] *
                          std::max(k_least_reflectance, w.segment.hit.reflectance[b]);
    }
    const double all = in_water + at_surface;
    if (!(all > 0)) return false;
    for (double& share : w.shares) share /= all;
    const double to_surface = at_surface / all;
    if (u < to_surface) return reflect_at_end(to_surface);
    return scatter_on_the_way((u - to_surface) / (1 - to_surface));
}

bool PathWalk::reflect_at_end(double probability) {
    Workspace& w = workspace_of_thread();
    const SurfaceHit& hit = w.segment.hit;
    Spectrum& throughput = state_.throughput;
    const std::size_t bands = tables_.optics.bands();
    for (std::size_t b = 0; b < bands; ++b) throughput[b] *= w.transmittance[b] / probability;
    w.vertex.reflect(tables_.vertices, w.segment, throughput);
    ++state_.reflections;
    return leave(above(hit));
}

bool PathWalk::scatter_on_the_way(double u) {
    Workspace& w = workspace_of_thread();
    const double s = draw_distance(u);
    if (!(s < w.segment.length) || !go_to(s)) return false;  // beyond k_far, or by rounding
    const Point3 x = w.segment.ray.at(s);
    w.vertex.scatter(tables_.vertices, x, w.segment.ray.direction, w.point, state_.throughput);
    ++state_.scatterings;
    return leave(x);
}

double PathWalk::draw_distance(double u) const {
    Workspace& w = workspace_of_thread();
    const WaterOptics& optics = tables_.optics;
    const std::size_t bands = optics.bands();
    w.cumulative.resize(bands);
    double total = 0;
    for (std::size_t b = 0; b < bands; ++b) {
        total += w.shares[b] * (1 - w.transmittance[b]);
        w.cumulative[b] = total;
    }
    if (!(total > 0)) return w.segment.length;
    const std::size_t band = choose(w.cumulative, u).index;
    const double depth = -std::log1p(-u * (1 - w.transmittance[band]));
    return optics.distance_at_depth(w.segment, band, depth);
}

bool PathWalk::go_to(double distance) {
    Workspace& w = workspace_of_thread();
    const WaterOptics& optics = tables_.optics;
    const std::size_t bands = optics.bands();
    optics.look_up(w.segment, distance, w.point);
    optics.find_scattering(w.point);
    w.c.resize(bands);
    optics.attenuations(w.point, w.c);
    optics.transmittances(distance, w.point.column, w.transmittance);
    double density = 0;
    for (std::size_t b = 0; b < bands; ++b) density += w.shares[b] * w.c[b] * w.transmittance[b];
    if (!(density > 0)) return false;
    for (std::size_t b = 0; b < bands; ++b) state_.throughput[b] *= w.transmittance[b] / density;
    return true;
}

// Directions towards lit surfaces are not worth guessing at: light that small angles lead there
// comes from all over them.
const WaterSegment* PathWalk::wander(const WaterSegment& segment) {
    constexpr double k_least_weight = 0.1, k_survival_of_many = 0.9;
    constexpr int k_many = 100;  // scatterings, in water that absorbs next to nothing
    Workspace& w = workspace_of_thread();
    const WaterOptics& optics = tables_.optics;
    if (optics.scene().surfaces->empty()) return nullptr;
    const std::size_t bands = optics.bands();
    Spectrum& throughput = state_.throughput;
    w.segment = segment;
    find_transmittance();
    w.shares.resize(bands);
    double first_weight = 0;
    for (bool is_first = true;; is_first = false) {
        // The first scattering has to be before the camera ray's surface. Later, the water decides
        // how far the path goes, and then it is seen what is in its way.
        double all = 0;
        for (std::size_t b = 0; b < bands; ++b) {
            w.shares[b] = throughput[b] * tables_.light[b];
            all += w.shares[b] * (1 - w.transmittance[b]);
        }
        if (!(all > 0)) return nullptr;
        for (double& share : w.shares) share /= all;
        const double s = draw_distance(random_.next());
        if (!is_first && meets_surface_before(s)) return &w.segment;
        if (!(s < w.segment.length) || !go_to(s)) return nullptr;
        if (is_first) state_.distance = s;
        const std::optional<Vector3> direction = scatter_plainly(
            tables_.scattering, w.point, w.segment.ray.direction, random_, throughput.first(bands));
        if (!direction) return nullptr;
        ++state_.scatterings;
        double weight = 0;
        for (std::size_t b = 0; b < bands; ++b) weight += throughput[b] * tables_.light[b];
        // What little is left of a path goes on in few, and none goes on for ever.
        if (is_first) first_weight = weight;
        if (!(weight > 0)) return nullptr;
        const double survival = std::min(weight / (k_least_weight * first_weight),
                                         state_.scatterings > k_many ? k_survival_of_many : 1);
        const double of_survival = random_.next();
        if (survival < 1) {
            if (of_survival >= survival) return nullptr;
            for (double& value : throughput.first(bands)) value /= survival;
        }
        optics.set({w.segment.ray.at(s), *direction}, nullptr, w.segment);
        std::ranges::fill(w.transmittance.first(bands), 0.0);
    }
}

// What is left of each band on the way, relative to all, weighs the path if there is one.
bool PathWalk::meets_surface_before(double distance) {
    Workspace& w = workspace_of_thread();
    const WaterOptics& optics = tables_.optics;
    WaterSegment& segment = w.segment;
    throw_if_stopped();
    segment.has_hit =
        optics.scene().surfaces->closest_hit(segment.ray, std::min(distance, k_far), segment.hit);
    if (!segment.has_hit) return false;
    segment.length = segment.hit.distance;
    find_transmittance();
    double all = 0;
    for (std::size_t b = 0; b < optics.bands(); ++b) all += w.shares[b] * w.transmittance[b];
    if (!(all > 0)) return false;
    for (std::size_t b = 0; b < optics.bands(); ++b)
        state_.throughput[b] *= w.transmittance[b] / all;
    return true;
}

void PathWalk::gather_lit_surface(const IndirectLight& indirect) {
    Workspace& w = workspace_of_thread();
    const std::size_t bands = tables_.optics.bands();
    for (double& value : w.transmittance.first(bands)) value = 1;  // the throughput has it already
    tables_.lamps.gather_from_surface(w.segment, w.transmittance, state_, random_, terms_);
    const SurfaceHit& hit = w.segment.hit;
    if (hit.has_material && tables_.optics.scene().surfaces->material(hit).is_glossy) {
        from_surface(w.segment);
        return;
    }
    w.indirect.resize(indirect.values());
    indirect.find(hit, w.indirect);
    for (std::size_t first = 0; first < w.indirect.size(); first += bands) {
        const std::span<double> radiance = std::span(w.indirect).subspan(first, bands);
        for (std::size_t b = 0; b < bands; ++b)
            radiance[b] *= hit.reflectance[b] * state_.throughput[b];
        PathTerm term = state_.term(first / bands, radiance);
        ++term.reflections;
        terms_.add(term);
    }
}

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
