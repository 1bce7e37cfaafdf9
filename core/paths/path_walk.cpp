#include "core/paths/path_walk.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/paths/irradiance_cache.h"

namespace uw {

namespace {

// The light that a path from a surface may meet anywhere, relative to what is reflected there.
constexpr double k_ambient_of_reflection = 0.2;
// Shares of the ambient light (and k_ambient_beyond): what is expected from any direction, at any
// place, and of a surface.
constexpr double k_ambient_of_direction = 0.05;
constexpr double k_ambient_of_place = 0.02, k_ambient_of_surface = 0.03;
// What is expected of a path after all, relative to what its direction was chosen for.
constexpr double k_min_expected = 0.2;
// The branches of one sampler, and of a path in all.
constexpr double k_max_splitting_of_vertex = 8, k_max_splitting_of_path = 64;
// Where nothing is known of the light, and after many vertices, fewer paths go on than arrive.
constexpr double k_max_survival_where_unknown = 0.97, k_max_survival_of_long = 0.9;
constexpr int k_long = 100;
constexpr int k_places = 3;
// None is guessed far darker than the mean: what shines there after all would be too bright.
constexpr double k_min_light_of_place = 0.3;
// Of what is mirrored by the water's surface, relative to the pixel's light.
constexpr double k_min_in_mirror = 0.1;
// What is expected to come from there, from any direction, relative to what is around.
constexpr double k_share_in_mirror = 0.3;
constexpr double k_work_of_plain_vertex = 0.1;
constexpr double k_golden = 0.6180339887498949;

// How far rays begin above the surface they leave, relative to the coordinates and to the last
// segment: above the rounding of single precision, in which surfaces are found.
constexpr double k_offset = 4e-7;

// The index of the weight that the running sum of `weights` reaches `target` with.
template <class Range, class Weight>
std::size_t sample_discrete(const Range& range, double target, const Weight& weight) {
    std::size_t i = 0;
    while (i + 1 < range.size() && target >= weight(range[i])) target -= weight(range[i++]);
    return i;
}

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
    DirectionSampler& sampler = workspace_of_thread().sampler;
    const Point3 x = segment.ray.at(point.distance);
    sampler.scatter(tables_.guides, x, segment.ray.direction, point, state_.throughput);
    ++state_.scatterings;
    add_vertex(PathVertex::Kind::scattered, x);
    follow(leave(x));
}

// As thorough as its light is worth by itself.
void PathWalk::from_surface(const WaterSegment& segment) {
    const double radiance = estimated_reflection(tables_.guides, segment.hit, state_.throughput);
    if (radiance > 0)
        expected_ = {.pixel = arriving(radiance), .ambient = k_ambient_of_reflection * radiance};
    workspace_of_thread().sampler.reflect(tables_.guides, segment, state_.throughput);
    state_.left = {segment.hit.position, segment.hit.geometric_normal, radiance};
    ++state_.reflections;
    add_vertex(PathVertex::Kind::reflected, segment.hit.position, &segment.hit);
    follow(leave(above(segment.hit)));
}

void PathWalk::add_vertex(PathVertex::Kind kind, const Point3& position, const SurfaceHit* hit) {
    state_.vertex = sink_.add_vertex(state_.vertex, {kind, position, hit});
}

// What is reflected along the path, as it arrives at the camera: the mean over the bands.
double PathWalk::arriving(double radiance) const {
    const std::size_t bands = tables_.optics.bands();
    double throughput = 0;
    for (const double value : state_.throughput.first(bands)) throughput += value;
    return throughput / static_cast<double>(bands) * radiance;
}

void PathWalk::split_at_surface(const WaterSegment& segment) {
    constexpr double k_min_splitting = 0.3, k_max_splitting = 4;
    Workspace& w = workspace_of_thread();
    const double light =
        arriving(estimated_reflection(tables_.guides, segment.hit, state_.throughput) +
                 k_ambient_beyond * expected_.ambient);
    const double n = std::clamp(light / expected_.pixel, k_min_splitting, k_max_splitting);
    const int count = static_cast<int>(n + random_.next());
    if (count == 0) return;
    for (double& value : state_.throughput.first(tables_.optics.bands())) value /= n;
    w.first_segment = segment;
    const PathState state = state_;
    const CameraSegment::Expected pixel = expected_;
    for (int i = 0; i < count; ++i) {
        state_ = state;
        expected_ = pixel;
        from_surface(w.first_segment);
    }
}

void PathWalk::mirror(const WaterSegment& segment) {
    workspace_of_thread().sampler.reflect(tables_.guides, segment, state_.throughput);
    ++state_.reflections;
    add_vertex(PathVertex::Kind::reflected, segment.hit.position, &segment.hit);
    leave(above(segment.hit), true);
}

bool PathWalk::leave(const Point3& origin, bool is_last) {
    Workspace& w = workspace_of_thread();
    const DirectionSampler& sampler = w.sampler;
    const std::size_t bands = tables_.optics.bands();
    ++work_;
    const double sum = sampler.sample_candidates(random_, expected_from(origin), w.candidates);
    const double of_candidate = random_.next(), of_number = random_.next();
    if (!(sum > 0)) return false;
    const DirectionCandidate chosen = w.candidates[sample_discrete(
        w.candidates, of_candidate * sum, [](const auto& each) { return each.weight(); })];
    Spectrum response;
    sampler.eval(chosen.direction, response);
    const double factor = sum / (chosen.response * chosen.light);
    for (std::size_t b = 0; b < bands; ++b) state_.throughput[b] *= response[b] * factor;
    const Ray ray{origin, chosen.direction};
    trace(ray);
    estimate_next_event();
    if (is_last) {
        if (!meets_water_surface()) return false;
        const double reflectance = reflectance_of_water_surface();
        for (std::size_t b = 0; b < bands; ++b)
            state_.throughput[b] *= w.transmittance[b] * reflectance;
        follow_mirrored();
        return false;
    }
    w.guides = &sampler.guides();
    find_surface_ahead();
    const double n = splitting_factor(chosen);
    if (!(of_number < n)) return false;
    for (double& value : state_.throughput.first(bands)) value /= n;
    state_.splitting *= n;
    for (double i = of_number + 1; i < n; ++i) w.pending.push_back({state_, ray});
    return true;
}

void PathWalk::estimate_next_event() {
    const Workspace& w = workspace_of_thread();
    tables_.lamps.estimate_in_scatter(w.segment, state_, random_, sink_);
    if (!w.segment.has_hit || stays_in_water_ || meets_water_surface()) return;
    tables_.lamps.estimate_direct_light(w.segment, w.transmittance, state_, random_, sink_);
    if (w.segment.hit.has_material) find_emission(state_.throughput);
}

bool PathWalk::meets_water_surface() const {
    const WaterSegment& segment = workspace_of_thread().segment;
    return segment.has_hit && segment.hit.is_water_surface;
}

Ray PathWalk::mirrored_ray() const {
    const WaterSegment& segment = workspace_of_thread().segment;
    return tables_.optics.scene().water_surface->reflected(
        segment.ray, {segment.hit.distance, -segment.hit.geometric_normal});
}

double PathWalk::reflectance_of_water_surface() const {
    const WaterSegment& segment = workspace_of_thread().segment;
    return tables_.optics.scene().water_surface->reflectance_from_water(
        -glm::dot(segment.ray.direction, segment.hit.geometric_normal));
}

void PathWalk::follow_mirrored() {
    add_vertex(PathVertex::Kind::mirrored, workspace_of_thread().segment.hit.position);
    trace(mirrored_ray());
    estimate_next_event();
}

// The surface that the path has left may be met again: all that is below its plane.
ExpectedRadiance PathWalk::expected_from(const Point3& x) const {
    ExpectedRadiance expected{.ambient = k_ambient_of_direction * expected_.ambient};
    const PathState::LeftSurface& left = state_.left;
    // The water's surface shows all of it again.
    if (tables_.optics.scene().water_surface)
        expected.ambient += k_share_in_mirror * std::max(left.radiance, expected_.pixel);
    const double height = glm::dot(x - left.position, left.normal);
    if (!(left.radiance > 0) || !(height > 0) || stays_in_water_) return expected;
    const WaterOptics& optics = tables_.optics;
    const double c = optics.attenuation().uniform[optics.clearest_band()];
    expected.of_surface = left.radiance * std::exp(-c * height);
    expected.normal = left.normal;
    return expected;
}

// As many as what is expected from the chosen direction is worth, relative to the pixel's light.
double PathWalk::splitting_factor(const DirectionCandidate& chosen) const {
    const Workspace& w = workspace_of_thread();
    const std::size_t bands = tables_.optics.bands();
    double throughput = 0;
    for (const double value : state_.throughput.first(bands)) throughput += value;
    const double expected =
        std::max(throughput * (w.guides->multiple(chosen.direction) + chosen.of_particles +
                               k_ambient_beyond * expected_.ambient) +
                     w.surface_ahead,
                 throughput * k_min_expected * chosen.light);
    double n = std::min(expected / (expected_.pixel * static_cast<double>(bands)),
                        k_max_splitting_of_vertex);
    n = std::min(n, k_max_splitting_of_path / state_.splitting);
    if (w.guides->all().empty()) n = std::min(n, k_max_survival_where_unknown);
    if (state_.scatterings + state_.reflections > k_long) n = std::min(n, k_max_survival_of_long);
    return n;
}

// The light of the surface at the end of the segment, as it arrives at the camera, roughly.
void PathWalk::find_surface_ahead() {
    Workspace& w = workspace_of_thread();
    w.surface_ahead = w.surface_radiance = 0;
    if (!w.segment.has_hit || (stays_in_water_ && !meets_water_surface())) return;
    Spectrum arriving;
    double arrived = 0;
    for (std::size_t b = 0; b < tables_.optics.bands(); ++b) {
        arriving[b] = state_.throughput[b] * w.transmittance[b];
        arrived += arriving[b];
    }
    if (!(arrived > 0)) return;
    if (meets_water_surface()) {
        w.surface_radiance = reflectance_of_water_surface() * radiance_in_mirror(arriving);
        w.surface_ahead = arrived * w.surface_radiance;
        return;
    }
    w.surface_radiance = std::max(k_ambient_of_surface * expected_.ambient,
                                  estimated_reflection(tables_.guides, w.segment.hit, arriving));
    w.surface_ahead = arrived * w.surface_radiance;
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
    expected_.pixel = std::max(expected_.pixel, light / static_cast<double>(bands));
    expected_.ambient =
        std::max(expected_.ambient, emission / (k_ambient_beyond * static_cast<double>(bands)));
}

// What the water's surface mirrors, roughly: scattered light, and the next surface. There may be
// some where nothing is known of it.
double PathWalk::radiance_in_mirror(const Spectrum& throughput) {
    Workspace& w = workspace_of_thread();
    const WaterOptics& optics = tables_.optics;
    const Ray mirrored = mirrored_ray();
    w.guides_at_water_surface.find(tables_.guides, mirrored.origin, throughput);
    double radiance =
        w.guides_at_water_surface.multiple(mirrored.direction) +
        tables_.guides.particles.at(mirrored.origin) +
        std::max(k_ambient_of_direction * expected_.ambient, k_min_in_mirror * expected_.pixel);
    SurfaceHit hit;
    if (optics.scene().surfaces->closest_hit(mirrored, k_far, hit) && !hit.is_water_surface)
        radiance += std::exp(-optics.attenuation().uniform[optics.clearest_band()] * hit.distance) *
                    estimated_reflection(tables_.guides, hit, throughput);
    return radiance;
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
        w.guides_of_pending.find(tables_.guides, pending.ray.origin, state_.throughput);
        w.guides = &w.guides_of_pending;
        find_surface_ahead();
        do {
            goes_on = advance();
        } while (goes_on);
    }
}

bool PathWalk::advance() {
    Workspace& w = workspace_of_thread();
    const WaterOptics& optics = tables_.optics;
    const std::size_t bands = optics.bands();
    const Spectrum to_end = w.transmittance;
    const double in_water = draw_places(to_end);
    const double all = in_water + w.surface_ahead;
    const double target = random_.next() * all;
    if (!(all > 0)) return false;
    if (target < w.surface_ahead) {
        for (std::size_t b = 0; b < bands; ++b)
            state_.throughput[b] *= to_end[b] * all / w.surface_ahead;
        if (meets_water_surface()) {
            const double reflectance = reflectance_of_water_surface();
            for (double& value : state_.throughput.first(bands)) value *= reflectance;
            follow_mirrored();
            w.guides_of_mirrored.find(tables_.guides, w.segment.ray.origin, state_.throughput);
            w.guides = &w.guides_of_mirrored;
            find_surface_ahead();
            return true;
        }
        w.sampler.reflect(tables_.guides, w.segment, state_.throughput);
        state_.left = {w.segment.hit.position, w.segment.hit.geometric_normal, w.surface_radiance};
        ++state_.reflections;
        add_vertex(PathVertex::Kind::reflected, w.segment.hit.position, &w.segment.hit);
        return leave(above(w.segment.hit));
    }
    if (w.places.empty()) return false;  // by rounding
    const Workspace::Place place = w.places[sample_discrete(
        w.places, target - w.surface_ahead, [](const auto& each) { return each.weight(); })];
    optics.look_up(w.segment, place.distance, w.point);
    optics.find_scattering(w.point);
    optics.transmittances(place.distance, w.point.column, w.transmittance);
    for (std::size_t b = 0; b < bands; ++b)
        state_.throughput[b] *= w.transmittance[b] * all / (place.scatters * place.light);
    const Point3 x = w.segment.ray.at(place.distance);
    w.sampler.scatter(tables_.guides, x, w.segment.ray.direction, w.point, state_.throughput);
    ++state_.scatterings;
    add_vertex(PathVertex::Kind::scattered, x);
    return leave(x);
}

// Draws places of the next scattering, by what the bands lose up to the end of the segment, of
// which `to_end` is left there. Returns the sum of their weights. Uses two random numbers.
double PathWalk::draw_places(const Spectrum& to_end) {
    Workspace& w = workspace_of_thread();
    const WaterOptics& optics = tables_.optics;
    const std::size_t bands = optics.bands();
    const double u_place = random_.next(), u_band = random_.next();
    w.shares.resize(bands);
    w.cumulative.resize(bands);
    w.c.resize(bands);
    w.places.clear();
    double lost = 0, to_surface = 0;
    for (std::size_t b = 0; b < bands; ++b) {
        w.shares[b] = state_.throughput[b] * tables_.light[b] * tables_.albedo[b];
        lost += w.shares[b] * (1 - to_end[b]);
        w.cumulative[b] = lost;
        to_surface = std::max(to_surface, to_end[b]);
    }
    if (!(lost > 0)) return 0;
    for (int k = 0; k < k_places; ++k) {
        double of_band = u_band + k * k_golden;
        of_band -= std::floor(of_band);
        const std::size_t band = choose(w.cumulative, of_band).index;
        const double share = (k + u_place) / k_places;
        Workspace::Place place;
        place.distance =
            optics.distance_at_depth(w.segment, band, -std::log1p(-share * (1 - to_end[band])));
        if (!(place.distance < w.segment.length)) continue;
        optics.look_up(w.segment, place.distance, w.point);
        optics.find_scattering(w.point);
        optics.attenuations(w.point, w.c);
        optics.transmittances(place.distance, w.point.column, w.transmittance);
        double clearest = 0;
        for (std::size_t b = 0; b < bands; ++b) {
            place.density += k_places * w.shares[b] * w.c[b] * w.transmittance[b] / lost;
            double scattering = 0;
            for (const Spectrum& m : w.point.scattering) scattering += m[b];
            place.scatters += state_.throughput[b] * w.transmittance[b] * scattering;
            clearest = std::max(clearest, w.transmittance[b]);
        }
        if (!(place.density > 0) || !(place.scatters > 0)) continue;
        place.light = w.guides->source(w.segment.ray.at(place.distance), w.segment.ray.direction) +
                      tables_.guides.particles.at(w.segment.ray.at(place.distance)) +
                      k_ambient_of_place * expected_.ambient;
        // The surface ahead, seen through the water by a small detour.
        if (w.surface_radiance > 0)
            place.light += w.surface_radiance * std::sqrt(std::min(1.0, to_surface / clearest));
        if (place.light > 0) w.places.push_back(place);
    }
    double sum = 0, plain = 0;
    for (const Workspace::Place& place : w.places) {
        sum += place.weight();
        plain += place.scatters / place.density;
    }
    if (!(sum > 0)) return 0;
    const double least = k_min_light_of_place * sum / plain;
    sum = 0;
    for (Workspace::Place& place : w.places) {
        place.light = std::max(place.light, least);
        sum += place.weight();
    }
    return sum;
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
    constexpr double k_min_weight = 0.1, k_max_survival_of_many = 0.9;
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
        if (!is_first && meets_surface_before(s)) {
            if (!meets_water_surface()) return &w.segment;
            const double reflectance = reflectance_of_water_surface();
            for (double& value : throughput.first(bands)) value *= reflectance;
            add_vertex(PathVertex::Kind::mirrored, w.segment.hit.position);
            optics.set(mirrored_ray(), nullptr, w.segment);
            std::ranges::fill(w.transmittance.first(bands), 0.0);
            continue;
        }
        if (!(s < w.segment.length) || !go_to(s)) return nullptr;
        if (is_first) state_.distance = s;
        const std::optional<Vector3> direction = sample_phase_function(
            tables_.scattering, w.point, w.segment.ray.direction, random_, throughput.first(bands));
        if (!direction) return nullptr;
        ++state_.scatterings;
        add_vertex(PathVertex::Kind::scattered, w.segment.ray.at(s));
        work_ += k_work_of_plain_vertex;
        double weight = 0;
        for (std::size_t b = 0; b < bands; ++b) weight += throughput[b] * tables_.light[b];
        // What little is left of a path goes on in few, and none goes on for ever.
        if (is_first) first_weight = weight;
        if (!(weight > 0)) return nullptr;
        const double survival = std::min(weight / (k_min_weight * first_weight),
                                         state_.scatterings > k_many ? k_max_survival_of_many : 1);
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

// The throughput has the transmittance already.
void PathWalk::estimate_surface_light() {
    Workspace& w = workspace_of_thread();
    for (double& value : w.transmittance.first(tables_.optics.bands())) value = 1;
    tables_.lamps.estimate_direct_light(w.segment, w.transmittance, state_, random_, sink_);
    if (w.segment.hit.has_material) find_emission(state_.throughput);
}

void PathWalk::trace_lit_surface() {
    estimate_surface_light();
    split_at_surface(workspace_of_thread().segment);
}

void PathWalk::trace_lit_surface(const IrradianceCache& indirect) {
    Workspace& w = workspace_of_thread();
    const std::size_t bands = tables_.optics.bands();
    estimate_surface_light();
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
        PathContribution contribution = state_.contribution(first / bands, radiance);
        ++contribution.reflections;
        sink_.add(contribution);
    }
}

}  // namespace uw
