#include "core/paths/next_event_estimator.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/geometry/glass.h"
#include "core/geometry/surface_reflection.h"
#include "core/light/integrator.h"
#include "core/paths/scattering_tables.h"

namespace uw {

namespace {

// Below this optical depth the light counts as constant along the interval.
constexpr double k_even_depth = 1e-6;

// The scattering that a field of unknown profile may add, for choosing a phase function, relative
// to the known scattering.
constexpr double k_field_fraction = 0.25;

// Where a segment leads into Snell's window or at most so far beside it [rad], a direction of the
// sky is sampled with this probability by the phase functions, whose forward peak may be much
// narrower than a part of the sky.
constexpr double k_beside_window = 0.2, k_phase_probability = 0.5;
// A part of the sky of which only the edge lights a surface counts as if it stood this high above
// it, relative to where its direction would stand if it were as high as the edge.
constexpr double k_edge_of_sky = 0.25;

// The cosine, to a surface's normal, with which a part of the sky is expected to light it.
// `cosine`: that of the part's direction. 0 only if all of the part stands below the surface's
// horizon.
double expected_cosine(const SkyEmitter& sky, double cosine) {
    const double half_angle = sky.part().half_angle, of_half = std::cos(half_angle);
    const double edge = cosine < of_half
                            ? cosine * of_half + std::sqrt(std::max(0.0, 1 - cosine * cosine)) *
                                                     std::sin(half_angle)
                            : 1;
    return std::max({0.0, cosine, k_edge_of_sky * edge});
}

}  // namespace

double ParallelLightInterval::effective_length() const {
    const double depth = rate_ * lit_.length();
    return std::abs(depth) < k_even_depth ? lit_.length() : -std::expm1(-depth) / rate_;
}

double ParallelLightInterval::sample(double u) const {
    const double depth = rate_ * lit_.length();
    const double s = std::abs(depth) < k_even_depth ? u * lit_.length()
                                                    : -std::log1p(u * std::expm1(-depth)) / rate_;
    return lit_.begin + std::clamp(s, 0.0, lit_.length());
}

double ParallelLightInterval::pdf(double s) const {
    const double depth = rate_ * lit_.length();
    if (std::abs(depth) < k_even_depth) return 1 / lit_.length();
    return std::exp(-rate_ * (s - lit_.begin)) / effective_length();
}

void InScatterSampler::prepare(const WaterOptics& optics, const ScatteringTables& tables,
                               std::span<const SkyEmitter* const> skies,
                               const WaterSegment& segment, const PathState& state) {
    const std::vector<Lamp>& lamps = *optics.scene().emitters;
    const std::size_t phases = tables.phase_count();
    // The phase functions are weighted by the scattering along the whole segment. Only the variance
    // depends on the choice.
    const Medium& medium = *optics.scene().medium;
    phase_weights_.assign(phases, 1.0);
    if (phases > 1) {
        const ConcentrationProfile& profile = segment.profile;
        const std::size_t count = optics.constituents();
        const double c = optics.attenuation().uniform[0];
        const double length = c > 0 ? std::min(segment.length, 1 / c) : segment.length;
        double total = 0;
        for (std::size_t m = 0; m < phases; ++m) {
            double sum = 0;
            for (std::size_t b = 0; b < optics.bands(); ++b) {
                double depth = medium.uniform.scattering[m][b] * length;
                if (!profile.s.empty())
                    for (std::size_t k = 0; k < count; ++k)
                        depth += medium.constituents[k].per_unit.scattering[m][b] *
                                 profile.column[profile.column.size() - count + k];
                sum += depth * state.throughput[b];
            }
            phase_weights_[m] = sum;
            total += sum;
        }
        // A field may scatter where its profile is not known, or where nothing else does.
        if (segment.has_field || !(total > 0))
            for (std::size_t m = 0; m < phases; ++m)
                phase_weights_[m] +=
                    tables.phase_fractions[m] * (total > 0 ? k_field_fraction * total : 1);
    }
    candidates_.clear();
    cumulative_.clear();
    masses_.clear();
    const auto arriving = [&](std::size_t lamp, double length) {
        return optics.attenuated_sum(state.throughput, lamps[lamp].axis_intensity(), length);
    };
    double total = 0;
    for (std::size_t j = 0; j < lamps.size(); ++j) {
        if (lamps[j].is_met_by_paths()) continue;
        const Interval lit = lamps[j].beam(segment.ray, {0, segment.length});
        if (!(lit.length() > 0)) continue;
        LampPassage passage = lamps[j].passage(segment.ray);
        if (passage.parallel) {
            if (!skies.empty() && skies[j])  // about the mean over the part
                passage.tangent = std::hypot(passage.tangent, 0.5 * skies[j]->part().half_angle);
            Candidate candidate = parallel_candidate(optics, tables, segment, j, passage, lit);
            const double weight = candidate.mass * candidate.interval.effective_length() *
                                  arriving(j, lit.begin + passage.radius(lit.begin));
            if (!(weight > 0)) continue;
            total += weight;
            candidates_.push_back(candidate);
            cumulative_.push_back(total);
            continue;
        }
        passage.distance = std::max(passage.distance, 1e-12 * (1 + std::abs(passage.foot)));
        Candidate candidate{.lamp = j,
                            .foot = passage.foot,
                            .distance = passage.distance,
                            .parts = {},
                            .first_masses = masses_.size(),
                            .interval = {},
                            .passage = {}};
        const auto add_part = [&](double begin, double end) {
            if (!(end > begin)) return;
            const Candidate::HalfTangents part{passage.half_tangent(begin, passage.radius(begin)),
                                               passage.half_tangent(end, passage.radius(end))};
            double mass = 0;
            for (std::size_t m = 0; m < phases; ++m) {
                masses_.push_back(
                    {tables.lines[m].mass_to(part.begin), tables.lines[m].mass_to(part.end)});
                mass += phase_weights_[m] * (masses_.back().to - masses_.back().from);
            }
            if (!(mass > 0)) {
                masses_.resize(masses_.size() - phases);
                return;
            }
            candidate.parts[candidate.part_count++] = part;
            candidate.mass += mass;
        };
        if (passage.distance >= k_lamp_radius) {
            add_part(lit.begin, lit.end);
        } else {
            const double half =
                std::sqrt(k_lamp_radius * k_lamp_radius - passage.distance * passage.distance);
            add_part(lit.begin, std::min(lit.end, passage.foot - half));
            add_part(std::max(lit.begin, passage.foot + half), lit.end);
        }
        if (candidate.part_count == 0) continue;
        // The length R + s of the light path of a lamp never decreases along the segment, so that
        // the transmittance is greatest at its beginning.
        const double weight = lamps.size() == 1
                                  ? 1
                                  : candidate.mass / candidate.distance *
                                        arriving(j, lit.begin + passage.radius(lit.begin));
        if (!(weight > 0)) continue;
        total += weight;
        candidates_.push_back(candidate);
        cumulative_.push_back(total);
    }
}

InScatterSampler::Candidate InScatterSampler::parallel_candidate(
    const WaterOptics& optics, const ScatteringTables& tables, const WaterSegment& segment,
    std::size_t lamp, const LampPassage& passage, const Interval& lit) {
    Candidate candidate;
    candidate.lamp = lamp;
    candidate.parallel = true;
    candidate.passage = passage;
    phase_.resize(tables.phase_count());
    tables.phase(passage.tangent, phase_);
    for (std::size_t m = 0; m < phase_.size(); ++m) candidate.mass += phase_weights_[m] * phase_[m];
    // The clearest band that attenuates at all decides; if there is none, only the field counts.
    const AttenuationTable& attenuation = optics.attenuation();
    double min_attenuation = k_far;
    for (std::size_t b = 0; b < optics.bands(); ++b)
        if (attenuation.uniform[b] > 0)
            min_attenuation = std::min(min_attenuation, attenuation.uniform[b]);
    if (min_attenuation < k_far) {
        candidate.attenuation = min_attenuation;
        candidate.interval = {passage, lit, min_attenuation};
        return candidate;
    }
    const Interval field = inside(segment.ray, optics.scene().field->bounds());
    const Interval both{std::max(lit.begin, field.begin), std::min(lit.end, field.end)};
    candidate.interval = {passage, both.length() > 0 ? both : Interval{}, 0};
    return candidate;
}

std::optional<ScatterPlace> InScatterSampler::sample(const ScatteringTables& tables,
                                                     std::span<const SkyEmitter* const> skies,
                                                     const WaterSegment& segment, double u_lamp,
                                                     double u_phase, double u_angle,
                                                     PathRandom& random) {
    if (candidates_.empty()) return std::nullopt;
    const Choice chosen = uw::choose(cumulative_, u_lamp);
    const Candidate& candidate = candidates_[chosen.index];
    std::optional<ScatterPlace> place;
    if (!candidate.parallel)
        place = sample_around(tables, candidate, segment.length, u_phase, u_angle);
    else if (!skies.empty() && skies[candidate.lamp])
        place = sample_sky(tables, *skies[candidate.lamp], candidate, segment.ray, u_phase, u_angle,
                           random);
    else
        place = sample_parallel(candidate, u_angle);
    if (place) place->pdf *= chosen.probability;
    return place;
}

std::optional<ScatterPlace> InScatterSampler::sample_sky(const ScatteringTables& tables,
                                                         const SkyEmitter& sky,
                                                         const Candidate& candidate, const Ray& ray,
                                                         double u_phase, double u_distance,
                                                         PathRandom& random) const {
    const double u = random.next(), v = random.next();
    const WaterSurfaceDesc& surface = sky.sunlight()->surface;
    const double window = std::sqrt(1 - 1 / (*surface.n * *surface.n));  // cosine of its half angle
    const bool is_ahead =
        glm::dot(ray.direction, surface.normal) > std::cos(std::acos(window) + k_beside_window);
    double total = 0;
    for (const double weight : phase_weights_) total += weight;
    const bool by_phase = is_ahead && u_phase < k_phase_probability;
    Vector3 towards;
    if (by_phase) {
        double rest = u_phase / k_phase_probability * total;
        std::size_t m = 0;
        while (m + 1 < phase_weights_.size() && rest >= phase_weights_[m])
            rest -= phase_weights_[m++];
        towards = direction_around(ray.direction, tables.directions[m].sample(u), v);
        if (!(glm::dot(towards, surface.normal) > window)) return std::nullopt;
    } else {
        towards = sky.sample(u, v);
    }
    const LampPassage passage = sky.passage_of(ray, towards);
    // The balance heuristic for a sky that is sampled evenly, as it is about.
    const double evenly = 1 / (2 * std::numbers::pi * (1 - window));
    double mixture = evenly;
    if (is_ahead) {
        double pdf = 0;
        for (std::size_t m = 0; m < phase_weights_.size(); ++m)
            pdf += phase_weights_[m] / total * tables.directions[m].pdf(passage.tangent);
        mixture += k_phase_probability * (pdf * per_solid_angle(passage.tangent) - evenly);
    }
    const double pdf = by_phase ? mixture : mixture * sky.pdf(towards) / evenly;
    if (!(pdf > 0)) return std::nullopt;
    const ParallelLightInterval interval = candidate.interval.with(passage, candidate.attenuation);
    const double s = interval.sample(u_distance);
    return ScatterPlace{candidate.lamp,        s,       passage.tangent, passage.radius(s),
                        pdf * interval.pdf(s), towards, by_phase};
}

ScatterPlace InScatterSampler::sample_parallel(const Candidate& candidate, double u) {
    const double s = candidate.interval.sample(u);
    return {candidate.lamp, s, candidate.passage.tangent, candidate.passage.radius(s),
            candidate.interval.pdf(s)};
}

std::optional<ScatterPlace> InScatterSampler::sample_around(const ScatteringTables& tables,
                                                            const Candidate& candidate,
                                                            double length, double u_phase,
                                                            double u_angle) {
    const std::size_t phases = tables.phase_count();
    // Chooses a part of the segment and a phase function, then an angle.
    const std::span<const Masses> masses =
        std::span(masses_).subspan(candidate.first_masses, candidate.part_count * phases);
    cumulative_.clear();
    double total = 0;
    for (std::size_t i = 0; i < masses.size(); ++i) {
        total += phase_weights_[i % phases] * (masses[i].to - masses[i].from);
        cumulative_.push_back(total);
    }
    const std::size_t pick = uw::choose(cumulative_, u_phase).index;
    const auto [from, to] = masses[pick];
    const Candidate::HalfTangents& part = candidate.parts[pick / phases];
    const double h = std::clamp(tables.lines[pick % phases].invert(from + u_angle * (to - from)),
                                part.begin, part.end);
    if (!(h > 0)) return std::nullopt;
    const double s =
        std::clamp(candidate.foot - candidate.distance * (1 - h * h) / (2 * h), 0.0, length);
    double density = 0;  // per unit of h
    for (std::size_t m = 0; m < phases; ++m)
        density += phase_weights_[m] * tables.lines[m].density(h);
    density /= total;
    if (!(density > 0)) return std::nullopt;
    // The pdf per unit of s, times R^2: ds / R^2 = 2 dh / ((1 + h^2) D).
    return ScatterPlace{candidate.lamp, s, h, candidate.distance * (1 + h * h) / (2 * h),
                        0.5 * (1 + h * h) * candidate.distance * density};
}

NextEventEstimator::NextEventEstimator(const WaterOptics& optics, const ScatteringTables& tables,
                                       std::vector<std::shared_ptr<const DeepShadow>> deep_shadows,
                                       std::vector<std::size_t> emitters)
    : optics_(optics),
      tables_(tables),
      skies_(sky_emitters(*optics.scene().emitters)),
      evenness_(optics.scene()),
      deep_shadows_(std::move(deep_shadows)),
      emitters_(std::move(emitters)) {}

void NextEventEstimator::dim_by_glass(const Point3& origin, const Point3& x,
                                      std::span<double> radiance) const {
    if (optics_.scene().glass == nullptr) return;
    const Spectrum left = optics_.scene().glass->transmittance(origin, x);
    for (std::size_t b = 0; b < radiance.size(); ++b) radiance[b] *= left[b];
}

void NextEventEstimator::column_to_lamp(std::size_t lamp, const Point3& x,
                                        std::span<double> column) const {
    if (column.empty()) return;
    if (deep_shadows_.empty())
        optics_.scene().field->column((*optics_.scene().emitters)[lamp].origin(x), x, column);
    else
        deep_shadows_[lamp]->columns(std::span(&x, 1), column);
}

void NextEventEstimator::column_to_sky(std::size_t lamp, const Point3& x, const Point3& origin,
                                       std::span<double> column) const {
    if (column.empty()) return;
    if (deep_shadows_.empty()) {
        optics_.scene().field->column(origin, x, column);
        return;
    }
    deep_shadows_[lamp]->columns(std::span(&x, 1), column);
    const double of_lamp = distance((*optics_.scene().emitters)[lamp].origin(x), x);
    for (double& value : column) value *= of_lamp > 0 ? distance(origin, x) / of_lamp : 1;
}

void NextEventEstimator::estimate_in_scatter(const WaterSegment& segment, const PathState& state,
                                             PathRandom& random, ContributionSink& sink,
                                             NextEventScratch& w) const {
    const double u_lamp = random.next(), u_phase = random.next(), u_angle = random.next();
    const std::size_t phases = tables_.phase_count();
    if (phases == 0) return;
    w.in_scatter.prepare(optics_, tables_, skies_, segment, state);
    const std::optional<ScatterPlace> place =
        w.in_scatter.sample(tables_, skies_, segment, u_lamp, u_phase, u_angle, random);
    if (!place) return;
    const double s = place->s;

    const Lamp& lamp = (*optics_.scene().emitters)[place->lamp];
    const SkyEmitter* const sky = skies_.empty() ? nullptr : skies_[place->lamp];
    const Point3 x = segment.ray.at(s);
    const Point3 origin = sky ? x + place->radius * place->towards_sky : lamp.origin(x);
    const double relative = sky ? 1 : lamp.relative_intensity(x - origin) * lamp.focus(x);
    if (!(relative > 0) || optics_.scene().surfaces->occluded(origin, x)) return;
    optics_.look_up(segment, s, w.point);
    optics_.find_scattering(w.point);
    w.column.resize(optics_.constituents());
    if (place->is_any_sky)
        optics_.scene().field->column(origin, x, w.column);
    else if (sky)
        column_to_sky(place->lamp, x, origin, w.column);
    else
        column_to_lamp(place->lamp, x, w.column);
    add(w.column, w.point.column);
    w.p.resize(phases);
    tables_.phase(place->half_tangent, w.p);
    const std::size_t bands = optics_.bands();
    const std::span<double> radiance = w.radiance.first(bands);
    optics_.transmittances(s + place->radius, w.column, w.radiance);
    const Spectrum even = evenness_.of(lamp.index(), segment.ray, {0, segment.length});
    const double factor = relative / place->pdf;
    if (sky)
        w.sky_radiance = place->is_any_sky ? sky->parts().radiance(sky->in_sky(place->towards_sky))
                                           : sky->radiance(place->towards_sky, lamp);
    const Spectrum& intensity = sky ? w.sky_radiance : lamp.axis_intensity();
    for (std::size_t b = 0; b < bands; ++b) {
        double beta = 0;
        for (std::size_t m = 0; m < phases; ++m) beta += w.point.scattering[m][b] * w.p[m];
        radiance[b] *= factor * even[b] * beta * intensity[b] * state.throughput[b];
    }
    dim_by_glass(origin, x, radiance);
    PathContribution contribution = state.contribution(lamp.index(), radiance);
    if (contribution.scatterings + contribution.reflections == 0)
        contribution.distance = s;  // on the camera ray
    ++contribution.scatterings;
    contribution.place = x;
    contribution.emitter = emitters_[place->lamp];
    sink.add(contribution);
}

void NextEventEstimator::estimate_direct_light(const WaterSegment& segment,
                                               const Spectrum& transmittance,
                                               const PathState& state, PathRandom& random,
                                               ContributionSink& sink, NextEventScratch& w) const {
    double u = random.next();
    const std::size_t bands = optics_.bands();
    const std::vector<Lamp>& lamps = *optics_.scene().emitters;
    const SurfaceHit& hit = segment.hit;
    const SurfaceSample sample{segment.ray, hit, 0, 0};
    const SurfaceReflection reflection(*optics_.scene().surfaces, sample, static_cast<int>(bands));
    const std::span<double> radiance = w.radiance.first(bands);
    if (reflection.emits()) {
        for (std::size_t b = 0; b < bands; ++b)
            radiance[b] = state.throughput[b] * transmittance[b] * reflection.emission()[b];
        PathContribution contribution = state.contribution(k_no_lamp, radiance);
        contribution.place = hit.position;
        contribution.hit = &hit;
        sink.add(contribution);
    }
    w.direct.clear();
    w.cumulative.clear();
    double total = 0;
    for (std::size_t j = 0; j < lamps.size(); ++j) {
        if (lamps[j].is_met_by_paths()) continue;
        const SkyEmitter* const sky = skies_.empty() ? nullptr : skies_[j];
        const Vector3 to_lamp = lamps[j].origin(hit.position) - hit.position;
        const double towards = glm::dot(hit.normal, to_lamp);
        if (!sky && (towards <= 0 || glm::dot(hit.geometric_normal, to_lamp) <= 0)) continue;
        const double relative =
            lamps[j].relative_intensity(-to_lamp) * lamps[j].focus(hit.position);
        if (!(relative > 0)) continue;
        const double radius = glm::length(to_lamp);
        const double geometry = sky ? expected_cosine(*sky, towards / radius)
                                    : relative * towards / (lamps[j].spread(radius) * radius);
        const double weight =
            lamps.size() == 1 ? 1
                              : geometry * optics_.attenuated_sum(
                                               state.throughput, lamps[j].axis_intensity(), radius);
        if (!(weight > 0)) continue;
        total += weight;
        w.direct.push_back({j, radius, geometry});
        w.cumulative.push_back(total);
    }
    if (w.direct.empty()) return;
    const auto [chosen, probability] = choose(w.cumulative, u);
    NextEventScratch::DirectCandidate candidate = w.direct[chosen];
    const Lamp& lamp = lamps[candidate.lamp];
    Point3 origin = lamp.origin(hit.position);
    const SkyEmitter* const sky = skies_.empty() ? nullptr : skies_[candidate.lamp];
    if (sky) {
        const double first = random.next(), second = random.next();
        const Vector3 towards = sky->sample(first, second);
        const double pdf = sky->pdf(towards);
        candidate.geometry = glm::dot(hit.normal, towards);
        if (!(pdf > 0) || candidate.geometry <= 0 || glm::dot(hit.geometric_normal, towards) <= 0)
            return;
        candidate.radius = sky->length_to(hit.position, towards);
        origin = hit.position + candidate.radius * towards;
        w.sky_radiance = sky->radiance(towards, lamp) / pdf;
    }
    const Spectrum& intensity = sky ? w.sky_radiance : lamp.axis_intensity();
    if (optics_.scene().surfaces->occluded(origin, hit.position)) return;
    w.column.resize(optics_.constituents());
    if (sky)
        column_to_sky(candidate.lamp, hit.position, origin, w.column);
    else
        column_to_lamp(candidate.lamp, hit.position, w.column);
    reflection.brdf(origin, w.brdf);
    optics_.transmittances(candidate.radius, w.column, w.radiance);
    for (std::size_t b = 0; b < bands; ++b)
        radiance[b] *= candidate.geometry / probability * intensity[b] * w.brdf[b] *
                       transmittance[b] * state.throughput[b];
    dim_by_glass(origin, hit.position, radiance);
    PathContribution contribution = state.contribution(lamp.index(), radiance);
    ++contribution.reflections;
    contribution.place = hit.position;
    contribution.hit = &hit;
    contribution.emitter = emitters_[candidate.lamp];
    sink.add(contribution);
}

}  // namespace uw
