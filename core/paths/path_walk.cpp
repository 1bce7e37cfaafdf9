#include "core/paths/path_walk.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/error.h"
#include "core/geometry/glass.h"
#include "core/paths/glass_passage.h"
#include "core/paths/irradiance_cache.h"

namespace uw {

namespace {

/// Adjoint-driven Russian roulette and splitting.
struct SplittingOptions {
    /// The splitting factors of one vertex, and their product along a path, are no larger.
    double max_of_vertex = 8, max_of_path = 64;
    /// The expected contribution is at least this, relative to what the direction was chosen for.
    double min_relative_contribution = 0.2;
    /// Where nothing is known of the light, and after many vertices, the factor is no larger, so
    /// that no path goes on for ever.
    double max_where_unknown = 0.97, max_of_long_path = 0.9;
    /// The number of vertices after which a path is long.
    int long_path = 100;
    /// The limits of the factor of a lit surface at which a random walk has ended.
    double min_at_lit_surface = 0.3, max_at_lit_surface = 4;
};
constexpr SplittingOptions k_splitting_options;

/// What is expected where little is known: there may be some light after all, and the variance
/// would be great if a path found it where nothing is expected.
struct ExpectationOptions {
    /// The light from any direction, at any place and of any surface, relative to the ambient
    /// light.
    double ambient_of_direction = 0.05, ambient_of_place = 0.02, ambient_of_surface = 0.03;
    /// The ambient light of a path that a surface reflects, relative to what is reflected there.
    double ambient_of_reflection = 0.2;
    /// The light that the water's surface mirrors, relative to the pixel's.
    double pixel_in_mirror = 0.1;
    /// The light that arrives from the water's surface from any direction, relative to the pixel's
    /// and to that of the surface that the path has left: it shows all of both again.
    double around_in_mirror = 0.3;
};
constexpr ExpectationOptions k_expectation_options;

/// Resampled importance sampling of the distance.
struct DistanceOptions {
    /// Candidates of a collision on the segment; the surface at its end is one more.
    int candidates = 3;
    /// No collision is expected to scatter less light than this, relative to the candidates' mean:
    /// what shines there after all would be too bright.
    double min_relative_radiance = 0.3;
    /// The golden ratio less one, whose multiples spread the candidates evenly over the bands.
    double golden = 0.6180339887498949;
};
constexpr DistanceOptions k_distance_options;

/// The analog random walk.
struct RandomWalkOptions {
    /// Below this throughput, relative to that after the first scattering, the walk survives in
    /// proportion to it.
    double min_relative_throughput = 0.1;
    /// After this many scatterings it survives with no more than this probability, for water that
    /// absorbs next to nothing.
    int long_walk = 100;
    double max_survival_of_long_walk = 0.9;
    /// The work of one of its vertices, relative to that of sampling a direction by all that is
    /// known.
    double work = 0.1;
};
constexpr RandomWalkOptions k_walk_options;

/// Reflection and refraction by the water's surface and glass.
struct SpecularOptions {
    /// Where no roulette ends a path, it meets this many specular surfaces in a row.
    int max_surfaces = 16;
};
constexpr SpecularOptions k_specular_options;

Spectrum ones(std::size_t bands) {
    return per_band(bands, [](std::size_t) { return 1.0; });
}

double sum_over_bands(const Spectrum& values, std::size_t bands) {
    double sum = 0;
    for (const double value : values.first(bands)) sum += value;
    return sum;
}

// The light that arrives along the path as it contributes to the pixel, mean over the bands.
double contribution_of(double radiance, const PathState& state, std::size_t bands) {
    return sum_over_bands(state.throughput, bands) / static_cast<double>(bands) * radiance;
}

bool meets_specular_surface(const WaterSegment& segment) {
    return segment.has_hit && is_specular(segment.hit);
}

}  // namespace

void PathWalk::trace_from_water(PathState state, const WaterSegment& segment,
                                const WaterPoint& point) {
    PathSegment& next = scratch_.segment;
    const DirectionSampler vertex = add_scattering(state, segment.ray, point, next.guides);
    trace_branches(state, next, vertex);
}

void PathWalk::trace_from_surface(PathState state, const SurfaceSample& surface) {
    const double radiance =
        estimated_reflection(tables_.guides, surface.hit, state.throughput, scratch_.column);
    if (radiance > 0)
        state.expected = {.pixel = contribution_of(radiance, state, tables_.optics.bands()),
                          .ambient = k_expectation_options.ambient_of_reflection * radiance};
    state.left = {surface.hit.position, surface.hit.geometric_normal, radiance};
    PathSegment& next = scratch_.segment;
    const DirectionSampler vertex = add_reflection(state, surface.ray, surface.hit, next.guides);
    trace_branches(state, next, vertex);
}

void PathWalk::trace_mirrored(PathState state, const SurfaceSample& surface) {
    state.meets_emission = false;
    PathSegment& next = scratch_.segment;
    const DirectionSampler vertex = add_reflection(state, surface.ray, surface.hit, next.guides);
    const bool goes_on = sample_direction(vertex, state).has_value();
    // The random number of the roulette that other paths play here: dimensions stay in step.
    random_.next();
    if (!goes_on) return;
    trace_segment(state, next);
    estimate_next_event(state, next);
    for (int i = 0; i < k_specular_options.max_surfaces && meets_specular_surface(next.water); ++i)
        if (!follow_specular(state, next, next.transmittance)) return;
}

// One branch after the other: sample a direction, estimate the next event along it, play Russian
// roulette or split, sample the distance of the next vertex.
void PathWalk::trace_branches(PathState state, PathSegment& segment,
                              std::optional<DirectionSampler> vertex) {
    const std::size_t bands = tables_.optics.bands();
    std::vector<PathState>& branches = scratch_.branches;
    branches.clear();
    for (;;) {
        while (vertex) {
            const std::optional<DirectionSample> direction = sample_direction(*vertex, state);
            const double u = random_.next();
            if (!direction) break;
            trace_segment(state, segment);
            estimate_next_event(state, segment);
            expect_surface(state, segment);
            const double q = splitting_factor(state, segment, *direction);
            if (!(u < q)) break;
            for (double& value : state.throughput.first(bands)) value /= q;
            state.splitting *= q;
            for (double i = u + 1; i < q; ++i) branches.push_back(state);
            vertex = sample_vertex(state, segment);
        }
        if (branches.empty()) return;
        // What surfaces were found to emit holds for all branches.
        const ExpectedLight expected = state.expected;
        state = branches.back();
        branches.pop_back();
        state.expected = expected;
        trace_segment(state, segment);
        segment.guides.find(tables_.guides, state.ray.origin, state.throughput);
        expect_surface(state, segment);
        vertex = sample_vertex(state, segment);
    }
}

std::optional<DirectionSample> PathWalk::sample_direction(const DirectionSampler& vertex,
                                                          PathState& state) {
    ++work_;
    const std::optional<DirectionSample> sample =
        vertex.sample(random_, expected_around(vertex.origin(), state));
    if (!sample) return sample;
    for (std::size_t b = 0; b < tables_.optics.bands(); ++b)
        state.throughput[b] *= sample->weight[b];
    state.ray = {vertex.origin(), sample->direction};
    return sample;
}

// The surface that the path has left may be met again: all that is below its plane.
ExpectedAtVertex PathWalk::expected_around(const Point3& x, const PathState& state) const {
    ExpectedAtVertex expected{.ambient = k_expectation_options.ambient_of_direction *
                                         state.expected.ambient};
    const PathState::LeftSurface& left = state.left;
    if (tables_.optics.scene().water_surface)
        expected.ambient +=
            k_expectation_options.around_in_mirror * std::max(left.radiance, state.expected.pixel);
    const double height = glm::dot(x - left.position, left.normal);
    if (!(left.radiance > 0) || !(height > 0) || state.stays_in_water) return expected;
    const WaterOptics& optics = tables_.optics;
    const double c = optics.attenuation().uniform[optics.clearest_band()];
    expected.of_surface = left.radiance * std::exp(-c * height);
    expected.normal = left.normal;
    return expected;
}

// The expected contribution of the light from the sampled direction, over the pixel's radiance.
double PathWalk::splitting_factor(const PathState& state, const PathSegment& segment,
                                  const DirectionSample& direction) const {
    constexpr const SplittingOptions& options = k_splitting_options;
    const std::size_t bands = tables_.optics.bands();
    const double throughput = sum_over_bands(state.throughput, bands);
    const double contribution =
        std::max(throughput * (segment.guides.multiple(direction.direction) +
                               direction.of_particles + k_ambient_beyond * state.expected.ambient) +
                     segment.surface_contribution,
                 throughput * options.min_relative_contribution * direction.radiance);
    double q = std::min(contribution / (state.expected.pixel * static_cast<double>(bands)),
                        options.max_of_vertex);
    q = std::min(q, options.max_of_path / state.splitting);
    if (segment.guides.all().empty()) q = std::min(q, options.max_where_unknown);
    if (state.scatterings + state.reflections > options.long_path)
        q = std::min(q, options.max_of_long_path);
    return q;
}

// By resampled importance sampling, too: the candidates are a few collisions and the surface at the
// segment's end, each in proportion to its expected contribution. A mirror is no vertex at which a
// direction is sampled: the path goes on behind it until there is one.
std::optional<DirectionSampler> PathWalk::sample_vertex(PathState& state, PathSegment& segment) {
    const WaterOptics& optics = tables_.optics;
    const std::size_t bands = optics.bands();
    std::vector<PathScratch::Collision>& collisions = scratch_.collisions;
    for (;;) {
        const double surface = segment.surface_contribution;
        const double sum = sample_collisions(state, segment, collisions) + surface;
        const double target = random_.next() * sum;
        if (!(sum > 0)) return std::nullopt;
        const WaterSegment& water = segment.water;
        if (!(target < surface)) {
            if (collisions.empty()) return std::nullopt;  // by rounding
            const PathScratch::Collision& chosen = choose_candidate(collisions, target - surface);
            WaterPoint& point = scratch_.point;
            optics.look_up(water, chosen.distance, point);
            optics.find_scattering(point);
            Spectrum transmittance;
            optics.transmittances(chosen.distance, point.column, transmittance);
            for (std::size_t b = 0; b < bands; ++b)
                state.throughput[b] *= transmittance[b] * sum / (chosen.response * chosen.radiance);
            return add_scattering(state, water.ray, point, segment.guides);
        }
        for (std::size_t b = 0; b < bands; ++b)
            state.throughput[b] *= segment.transmittance[b] * sum / surface;
        if (!meets_specular_surface(water)) {
            state.left = {water.hit.position, water.hit.geometric_normal, segment.surface_radiance};
            return add_reflection(state, water.ray, water.hit, segment.guides);
        }
        if (!follow_specular(state, segment, ones(bands))) return std::nullopt;
        segment.guides.find(tables_.guides, state.ray.origin, state.throughput);
        expect_surface(state, segment);
    }
}

// Samples candidates of the next collision by free flight up to the segment's end. Their density is
// the mean over that of the bands, by what light each of them loses: spectral multiple importance
// sampling (Miller et al. 2019). Returns the sum of their weights. Uses two random numbers.
double PathWalk::sample_collisions(const PathState& state, const PathSegment& segment,
                                   std::vector<PathScratch::Collision>& collisions) {
    constexpr const DistanceOptions& options = k_distance_options;
    const WaterOptics& optics = tables_.optics;
    const std::size_t bands = optics.bands();
    const double u_distance = random_.next(), u_band = random_.next();
    collisions.clear();
    const Spectrum& to_end = segment.transmittance;
    Spectrum weights, cumulative;
    double lost = 0, to_surface = 0;
    for (std::size_t b = 0; b < bands; ++b) {
        weights[b] = state.throughput[b] * tables_.light[b] * tables_.albedo[b];
        lost += weights[b] * (1 - to_end[b]);
        cumulative[b] = lost;
        to_surface = std::max(to_surface, to_end[b]);
    }
    if (!(lost > 0)) return 0;
    WaterPoint& point = scratch_.point;
    Spectrum attenuation, transmittance;
    for (int k = 0; k < options.candidates; ++k) {
        double of_band = u_band + k * options.golden;
        of_band -= std::floor(of_band);
        const std::size_t band = choose(cumulative.first(bands), of_band).index;
        const double u = (k + u_distance) / options.candidates;
        PathScratch::Collision collision;
        collision.distance =
            optics.distance_at_depth(segment.water, band, -std::log1p(-u * (1 - to_end[band])));
        if (!(collision.distance < segment.water.length)) continue;
        optics.look_up(segment.water, collision.distance, point);
        optics.find_scattering(point);
        optics.attenuations(point, attenuation.first(bands));
        optics.transmittances(collision.distance, point.column, transmittance);
        double clearest = 0;
        for (std::size_t b = 0; b < bands; ++b) {
            collision.density +=
                options.candidates * weights[b] * attenuation[b] * transmittance[b] / lost;
            double scattering = 0;
            for (const Spectrum& m : point.scattering) scattering += m[b];
            collision.response += state.throughput[b] * transmittance[b] * scattering;
            clearest = std::max(clearest, transmittance[b]);
        }
        if (!(collision.density > 0) || !(collision.response > 0)) continue;
        const Point3 x = segment.water.ray.at(collision.distance);
        collision.radiance = segment.guides.source(x, segment.water.ray.direction) +
                             tables_.guides.particles.at(x) +
                             k_expectation_options.ambient_of_place * state.expected.ambient;
        // The surface ahead, seen through the water by a small detour.
        if (segment.surface_radiance > 0)
            collision.radiance +=
                segment.surface_radiance * std::sqrt(std::min(1.0, to_surface / clearest));
        if (collision.radiance > 0) collisions.push_back(collision);
    }
    return sum_of_weights(collisions, options.min_relative_radiance);
}

DirectionSampler PathWalk::add_scattering(PathState& state, const Ray& ray, const WaterPoint& point,
                                          GuidingDistribution& guides) {
    const Point3 x = ray.at(point.distance);
    ++state.scatterings;
    state.was_scattered = true;
    add_vertex(state, PathVertex::Kind::scattered, x);
    guides.find(tables_.guides, x, state.throughput);
    return {tables_.guides, x, ray.direction, point, state.throughput, guides, scratch_.directions};
}

DirectionSampler PathWalk::add_reflection(PathState& state, const Ray& ray, const SurfaceHit& hit,
                                          GuidingDistribution& guides) {
    ++state.reflections;
    state.was_scattered = false;
    add_vertex(state, PathVertex::Kind::reflected, hit.position, &hit);
    guides.find(tables_.guides, hit.position, state.throughput);
    return {tables_.guides, ray, hit, state.throughput, guides, scratch_.directions};
}

void PathWalk::add_vertex(PathState& state, PathVertex::Kind kind, const Point3& position,
                          const SurfaceHit* hit) {
    state.vertex = sink_.add_vertex(state.vertex, {kind, position, hit});
}

void PathWalk::trace_segment(const PathState& state, PathSegment& segment) {
    tables_.optics.trace(state.ray, segment.water);
    segment.transmittance = transmittance(segment.water);
}

Spectrum PathWalk::transmittance(const WaterSegment& segment) {
    Spectrum values;
    if (!segment.has_hit) return values;  // nothing arrives from k_far
    tables_.optics.look_up(segment, segment.length, scratch_.point);
    tables_.optics.transmittances(segment.length, scratch_.point.column, values);
    return values;
}

bool PathWalk::follow_specular(PathState& state, PathSegment& segment, Spectrum factor) {
    const std::optional<Ray> ray = sample_specular(segment.water, state.throughput, factor);
    if (!ray) return false;
    for (std::size_t b = 0; b < tables_.optics.bands(); ++b) state.throughput[b] *= factor[b];
    add_vertex(state, PathVertex::Kind::mirrored, segment.water.hit.position);
    state.ray = *ray;
    trace_segment(state, segment);
    estimate_next_event(state, segment);
    return true;
}

std::optional<Ray> PathWalk::sample_specular(const WaterSegment& segment,
                                             const Spectrum& throughput, Spectrum& factor) {
    if (!segment.hit.is_water_surface)
        return sample_glass_passage(tables_.optics.scene(), segment.ray, segment.hit, throughput,
                                    random_, factor);
    const double reflectance = water_surface_reflectance(segment);
    for (double& value : factor.first(tables_.optics.bands())) value *= reflectance;
    return mirrored_ray(segment);
}

Ray PathWalk::mirrored_ray(const WaterSegment& segment) const {
    return tables_.optics.scene().water_surface->reflected(
        segment.ray, {segment.hit.distance, -segment.hit.geometric_normal});
}

double PathWalk::water_surface_reflectance(const WaterSegment& segment) const {
    return tables_.optics.scene().water_surface->reflectance_from_water(
        -glm::dot(segment.ray.direction, segment.hit.geometric_normal));
}

void PathWalk::estimate_next_event(PathState& state, const PathSegment& segment) {
    const WaterSegment& water = segment.water;
    tables_.lamps.estimate_in_scatter(water, state, random_, sink_, scratch_.next_event);
    // What lights a surface was added there (add_reflected_emission).
    if (state.was_scattered && state.meets_emission)
        tables_.guides.emission.estimate(tables_.optics, water, state, random_, sink_,
                                         scratch_.emission);
    if (!water.has_hit || state.stays_in_water || meets_specular_surface(water)) return;
    add_surface_light(state, water, segment.transmittance);
}

// What surfaces emit is not in the light that paths are measured by until one has seen it. Where
// lamps are faint beside it, paths would split for ever, and go on by chance alone.
void PathWalk::add_surface_light(PathState& state, const WaterSegment& segment,
                                 const Spectrum& transmittance) {
    tables_.lamps.estimate_direct_light(segment, transmittance, state, random_, sink_,
                                        scratch_.next_event);
    add_reflected_emission(state, segment, transmittance);
    if (!segment.hit.has_material) return;
    const std::size_t bands = tables_.optics.bands();
    const SurfaceMaterial material = tables_.optics.scene().surfaces->material(segment.hit);
    double contribution = 0, emission = 0;
    for (std::size_t b = 0; b < bands; ++b) {
        contribution += state.throughput[b] * material.emission[b];
        emission += material.emission[b];
    }
    ExpectedLight& expected = state.expected;
    expected.pixel = std::max(expected.pixel, contribution / static_cast<double>(bands));
    expected.ambient =
        std::max(expected.ambient, emission / (k_ambient_beyond * static_cast<double>(bands)));
}

// By multiple importance sampling (Veach 1997): half of the directions lead to points of the light,
// half follow the cosine to the normal. The density of the former falls to nothing near the light.
void PathWalk::add_reflected_emission(PathState state, const WaterSegment& segment,
                                      const Spectrum& transmittance) {
    const EmissionSampler& emission = tables_.guides.emission;
    if (emission.empty() || !state.meets_emission) return;
    const WaterOptics& optics = tables_.optics;
    const SurfaceHit& hit = segment.hit;
    const double technique = random_.next(), u = random_.next(), v = random_.next(),
                 w = random_.next();
    const Point3 x = point_above(hit);
    const Vector3 direction =
        technique < 0.5 ? emission.sample(x, u, v, w) : cosine_direction(hit.normal, u, v);
    const double cosine = glm::dot(hit.normal, direction);
    if (!(cosine > 0) || !(glm::dot(hit.geometric_normal, direction) > 0)) return;
    const double pdf = 0.5 * (emission.towards({x, direction}).pdf + cosine * std::numbers::inv_pi);
    const SurfaceSample surface{segment.ray, hit, 0, 0};
    Spectrum values;
    SurfaceReflection(*optics.scene().surfaces, surface, static_cast<int>(optics.bands()))
        .brdf_towards(direction, values);
    for (std::size_t b = 0; b < optics.bands(); ++b)
        state.throughput[b] *= transmittance[b] * values[b] * cosine / pdf;
    ++state.reflections;
    add_vertex(state, PathVertex::Kind::reflected, hit.position, &hit);
    WaterSegment& next = scratch_.towards_emission;
    optics.trace({x, direction}, next);
    emission.estimate(optics, next, state, random_, sink_, scratch_.emission);
    for (int i = 0; i < k_specular_options.max_surfaces && meets_specular_surface(next); ++i) {
        Spectrum factor = this->transmittance(next);
        const std::optional<Ray> ray = sample_specular(next, state.throughput, factor);
        if (!ray) return;
        for (std::size_t b = 0; b < optics.bands(); ++b) state.throughput[b] *= factor[b];
        add_vertex(state, PathVertex::Kind::mirrored, next.hit.position);
        optics.trace(*ray, next);
        emission.estimate(optics, next, state, random_, sink_, scratch_.emission);
    }
}

void PathWalk::expect_surface(const PathState& state, PathSegment& segment) {
    segment.surface_contribution = segment.surface_radiance = 0;
    const WaterSegment& water = segment.water;
    if (!water.has_hit || (state.stays_in_water && !meets_specular_surface(water))) return;
    Spectrum arriving;
    double arrived = 0;
    for (std::size_t b = 0; b < tables_.optics.bands(); ++b) {
        arriving[b] = state.throughput[b] * segment.transmittance[b];
        arrived += arriving[b];
    }
    if (!(arrived > 0)) return;
    segment.surface_radiance =
        meets_specular_surface(water)
            ? expected_from_specular(state, water, arriving)
            : std::max(k_expectation_options.ambient_of_surface * state.expected.ambient,
                       estimated_reflection(tables_.guides, water.hit, arriving, scratch_.column));
    segment.surface_contribution = arrived * segment.surface_radiance;
}

// Most glass lets most light through, and hardly bends it.
double PathWalk::expected_from_specular(const PathState& state, const WaterSegment& segment,
                                        const Spectrum& throughput) {
    if (segment.hit.is_water_surface)
        return water_surface_reflectance(segment) *
               expected_in_mirror(state, mirrored_ray(segment), throughput);
    return expected_in_mirror(state, {segment.hit.position, segment.ray.direction}, throughput);
}

// What a specular surface shows: scattered light, and the next surface that is not of glass.
double PathWalk::expected_in_mirror(const PathState& state, const Ray& mirrored,
                                    const Spectrum& throughput) {
    constexpr const ExpectationOptions& options = k_expectation_options;
    const WaterOptics& optics = tables_.optics;
    GuidingDistribution& guides = scratch_.guides_in_mirror;
    guides.find(tables_.guides, mirrored.origin, throughput);
    double radiance = guides.multiple(mirrored.direction) +
                      tables_.guides.particles.at(mirrored.origin) +
                      std::max(options.ambient_of_direction * state.expected.ambient,
                               options.pixel_in_mirror * state.expected.pixel);
    SurfaceHit hit;
    const Surfaces& surfaces =
        optics.scene().glass ? optics.scene().glass->surfaces().opaque() : *optics.scene().surfaces;
    if (surfaces.closest_hit(mirrored, k_far, hit) && !hit.is_water_surface)
        radiance += std::exp(-optics.attenuation().uniform[optics.clearest_band()] * hit.distance) *
                    estimated_reflection(tables_.guides, hit, throughput, scratch_.column);
    return radiance;
}

// Directions towards lit surfaces are not worth guessing at: light that small angles lead there
// comes from all over them.
const WaterSegment* PathWalk::walk_to_surface(PathState& state,
                                              const WaterSegment& camera_segment) {
    constexpr const RandomWalkOptions& options = k_walk_options;
    const WaterOptics& optics = tables_.optics;
    if (optics.scene().surfaces->empty()) return nullptr;
    const std::size_t bands = optics.bands();
    const std::span<double> throughput = state.throughput.first(bands);
    WaterSegment& segment = scratch_.segment.water;
    // The first scattering has to be before the camera ray's surface. Later, the water decides how
    // far the path goes, and then it is seen what is in its way.
    const WaterSegment* water = &camera_segment;
    Spectrum to_end = transmittance(camera_segment), weights;
    double first_weight = 0;
    for (bool is_first = true;; is_first = false) {
        double lost = 0;
        for (std::size_t b = 0; b < bands; ++b) {
            weights[b] = throughput[b] * tables_.light[b];
            lost += weights[b] * (1 - to_end[b]);
        }
        if (!(lost > 0)) return nullptr;
        for (double& weight : weights.first(bands)) weight /= lost;
        const double s = sample_free_flight(*water, weights, to_end, random_.next());
        if (!is_first && meets_surface_before(s, weights, state, segment)) {
            if (!meets_specular_surface(segment)) return &segment;
            Spectrum factor = ones(bands);
            const std::optional<Ray> ray = sample_specular(segment, state.throughput, factor);
            if (!ray) return nullptr;
            for (std::size_t b = 0; b < bands; ++b) throughput[b] *= factor[b];
            add_vertex(state, PathVertex::Kind::mirrored, segment.hit.position);
            state.ray = *ray;
            optics.set(state.ray, nullptr, segment);
            continue;
        }
        if (!(s < water->length) || !collide(state, *water, weights, s, scratch_.point))
            return nullptr;
        if (is_first) state.distance = s;
        const Point3 x = water->ray.at(s);
        const std::optional<Vector3> direction =
            sample_phase_function(tables_.scattering, scratch_.point, water->ray.direction, random_,
                                  throughput, scratch_.cumulative);
        if (!direction) return nullptr;
        ++state.scatterings;
        add_vertex(state, PathVertex::Kind::scattered, x);
        work_ += options.work;
        double weight = 0;
        for (std::size_t b = 0; b < bands; ++b) weight += throughput[b] * tables_.light[b];
        if (is_first) first_weight = weight;
        if (!(weight > 0)) return nullptr;
        const double survival =
            std::min(weight / (options.min_relative_throughput * first_weight),
                     state.scatterings > options.long_walk ? options.max_survival_of_long_walk : 1);
        const double u = random_.next();
        if (survival < 1) {
            if (u >= survival) return nullptr;
            for (double& value : throughput) value /= survival;
        }
        state.ray = {x, *direction};
        optics.set(state.ray, nullptr, segment);
        water = &segment;
        to_end = {};
    }
}

// The distance of the next collision, whose density is the mean over those of the bands; the
// segment's length if there is none.
double PathWalk::sample_free_flight(const WaterSegment& segment, const Spectrum& weights,
                                    const Spectrum& transmittance, double u) const {
    const std::size_t bands = tables_.optics.bands();
    Spectrum cumulative;
    double total = 0;
    for (std::size_t b = 0; b < bands; ++b) {
        total += weights[b] * (1 - transmittance[b]);
        cumulative[b] = total;
    }
    if (!(total > 0)) return segment.length;
    const std::size_t band = choose(cumulative.first(bands), u).index;
    const double depth = -std::log1p(-u * (1 - transmittance[band]));
    return tables_.optics.distance_at_depth(segment, band, depth);
}

// Divides by the density of sample_free_flight; false if the water does nothing there.
bool PathWalk::collide(PathState& state, const WaterSegment& segment, const Spectrum& weights,
                       double distance, WaterPoint& point) const {
    const WaterOptics& optics = tables_.optics;
    const std::size_t bands = optics.bands();
    optics.look_up(segment, distance, point);
    optics.find_scattering(point);
    Spectrum attenuation, transmittance;
    optics.attenuations(point, attenuation.first(bands));
    optics.transmittances(distance, point.column, transmittance);
    double density = 0;
    for (std::size_t b = 0; b < bands; ++b)
        density += weights[b] * attenuation[b] * transmittance[b];
    if (!(density > 0)) return false;
    for (std::size_t b = 0; b < bands; ++b) state.throughput[b] *= transmittance[b] / density;
    return true;
}

// If a surface is before that distance, it ends the segment. The probability of getting there is
// the mean over the bands.
bool PathWalk::meets_surface_before(double distance, const Spectrum& weights, PathState& state,
                                    WaterSegment& segment) {
    const WaterOptics& optics = tables_.optics;
    throw_if_stopped();
    segment.has_hit =
        optics.scene().surfaces->closest_hit(segment.ray, std::min(distance, k_far), segment.hit);
    if (!segment.has_hit) return false;
    segment.length = segment.hit.distance;
    const Spectrum to_surface = transmittance(segment);
    double all = 0;
    for (std::size_t b = 0; b < optics.bands(); ++b) all += weights[b] * to_surface[b];
    if (!(all > 0)) return false;
    for (std::size_t b = 0; b < optics.bands(); ++b) state.throughput[b] *= to_surface[b] / all;
    return true;
}

void PathWalk::trace_lit_surface(PathState state, const WaterSegment& segment) {
    const std::size_t bands = tables_.optics.bands();
    add_surface_light(state, segment, ones(bands));
    const SurfaceSample surface{segment.ray, segment.hit, 0, 0};
    const double contribution = contribution_of(
        estimated_reflection(tables_.guides, surface.hit, state.throughput, scratch_.column) +
            k_ambient_beyond * state.expected.ambient,
        state, bands);
    const double q =
        std::clamp(contribution / state.expected.pixel, k_splitting_options.min_at_lit_surface,
                   k_splitting_options.max_at_lit_surface);
    const int count = static_cast<int>(q + random_.next());
    for (double& value : state.throughput.first(bands)) value /= q;
    for (int i = 0; i < count; ++i) trace_from_surface(state, surface);
}

void PathWalk::trace_lit_surface(PathState state, const WaterSegment& segment,
                                 const IrradianceCache& indirect) {
    const std::size_t bands = tables_.optics.bands();
    add_surface_light(state, segment, ones(bands));
    const SurfaceHit& hit = segment.hit;
    if (hit.has_material && tables_.optics.scene().surfaces->material(hit).is_glossy) {
        trace_from_surface(state, {segment.ray, hit, 0, 0});
        return;
    }
    std::vector<double>& irradiance = scratch_.indirect;
    irradiance.resize(indirect.values());
    indirect.find(hit, irradiance);
    for (std::size_t first = 0; first < irradiance.size(); first += bands) {
        const std::span<double> radiance = std::span(irradiance).subspan(first, bands);
        for (std::size_t b = 0; b < bands; ++b)
            radiance[b] *= hit.reflectance[b] * state.throughput[b];
        PathContribution contribution = state.contribution(first / bands, radiance);
        ++contribution.reflections;
        sink_.add(contribution);
    }
}

}  // namespace uw
