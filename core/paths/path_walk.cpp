#include "core/paths/path_walk.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/paths/indirect_light.h"

namespace uw {

namespace {

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
// How far rays begin above the surface they leave, relative to the coordinates and to the last
// segment: above the rounding of single precision, in which surfaces are found.
constexpr double k_offset = 4e-7;

Point3 above(const SurfaceHit& hit) {
    const double scale = std::max({std::abs(hit.position.x), std::abs(hit.position.y),
                                   std::abs(hit.position.z), hit.distance});
    return hit.position + (k_offset * scale) * hit.geometric_normal;
}

}  // namespace

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

}  // namespace uw
