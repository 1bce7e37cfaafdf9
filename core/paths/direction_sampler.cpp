#include "core/paths/direction_sampler.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/geometry/surface_reflection.h"
#include "core/paths/scattering_tables.h"

namespace uw {

namespace {

struct DirectionOptions {
    /// Candidates of each technique: in the shape of f, and in that of the lamps' light. Without
    /// lamps, all are of the first.
    int candidates_per_technique = 3;
    /// Candidates of a scattering towards the light of emissive volumes, where there are any.
    int candidates_of_emission = 2;
    /// The probability with which a direction on a glossy surface is drawn from its specular lobe.
    double specular_probability = 0.5;
    /// No candidate's radiance is expected to be less than this, relative to the candidates' mean:
    /// what shines there after all would be too bright.
    double min_relative_radiance = 0.3;
    /// How far a path begins above the surface that it leaves, relative to the coordinates and to
    /// its last segment: above the rounding of single precision, in which surfaces are found.
    double offset = 4e-7;
    /// The golden ratio less one, whose multiples are spread evenly over the unit interval.
    double golden = 0.6180339887498949;
};
constexpr DirectionOptions k_direction;

double wrapped(double x) {
    return x - std::floor(x);
}

}  // namespace

Vector3 cosine_direction(const Vector3& normal, double u, double azimuth) {
    return direction_around(normal, std::sqrt(u) / (1 + std::sqrt(1 - u)), azimuth);
}

Point3 point_above(const SurfaceHit& hit) {
    const double scale = std::max({std::abs(hit.position.x), std::abs(hit.position.y),
                                   std::abs(hit.position.z), hit.distance});
    return hit.position + (k_direction.offset * scale) * hit.geometric_normal;
}

std::optional<Vector3> sample_phase_function(const ScatteringTables& tables,
                                             const WaterPoint& point, const Vector3& direction,
                                             PathRandom& random, std::span<double> throughput,
                                             std::vector<double>& cumulative) {
    double u = random.next();
    const double v = random.next(), azimuth = random.next();
    double total = 0;
    cumulative.clear();
    for (const Spectrum& b : point.scattering) {
        for (std::size_t band = 0; band < throughput.size(); ++band)
            total += throughput[band] * b[band];
        cumulative.push_back(total);
    }
    if (!(total > 0)) return std::nullopt;
    const Choice chosen = choose(cumulative, u);
    const Spectrum& b = point.scattering[chosen.index];
    for (std::size_t band = 0; band < throughput.size(); ++band)
        throughput[band] *= b[band] / chosen.probability;
    const HalfTangentDensity& phase = tables.directions[chosen.index];
    return direction_around(direction, phase.sample(v), azimuth);
}

DirectionSampler::DirectionSampler(const GuidingTables& tables, const Point3& x,
                                   const Vector3& incoming, const WaterPoint& point,
                                   const Spectrum& throughput, const GuidingDistribution& guides,
                                   Scratch& scratch)
    : tables_(&tables),
      guides_(&guides),
      scratch_(&scratch),
      x_(x),
      origin_(x),
      incoming_(incoming),
      scattering_(point.scattering),
      throughput_(throughput) {
    scratch_->phase_cumulative.clear();
    double total = 0;
    for (const Spectrum& b : scattering_) {
        for (std::size_t band = 0; band < tables_->optics.bands(); ++band)
            total += throughput[band] * b[band];
        scratch_->phase_cumulative.push_back(total);
    }
}

DirectionSampler::DirectionSampler(const GuidingTables& tables, const Ray& ray,
                                   const SurfaceHit& hit, const Spectrum& throughput,
                                   const GuidingDistribution& guides, Scratch& scratch)
    : tables_(&tables),
      guides_(&guides),
      scratch_(&scratch),
      x_(hit.position),
      origin_(point_above(hit)),
      incoming_(ray.direction),
      throughput_(throughput) {
    scratch_->surface = {ray, hit, 0, 0};
    reflection_.emplace(*tables_->optics.scene().surfaces, scratch_->surface,
                        static_cast<int>(tables_->optics.bands()));
}

std::optional<DirectionSample> DirectionSampler::sample(PathRandom& random,
                                                        const ExpectedAtVertex& expected) const {
    const double sum = sample_candidates(random, expected), u = random.next();
    if (!(sum > 0)) return std::nullopt;
    const Scratch::Candidate& chosen = choose_candidate(scratch_->candidates, u * sum);
    DirectionSample sample{.direction = chosen.direction,
                           .weight = {},
                           .radiance = std::max(0.0, chosen.radiance - chosen.emitted),
                           .of_particles = chosen.of_particles};
    eval(chosen.direction, sample.weight);
    const double factor = sum / (chosen.response * chosen.radiance);
    for (double& value : sample.weight.first(tables_->optics.bands())) value *= factor;
    return sample;
}

// Returns the sum of the candidates' weights. They are stratified.
double DirectionSampler::sample_candidates(PathRandom& random,
                                           const ExpectedAtVertex& expected) const {
    std::vector<Scratch::Candidate>& candidates = scratch_->candidates;
    candidates.clear();
    const double u_guide = random.next(), azimuth_guide = random.next();
    const double u_local = random.next(), v_local = random.next();
    const bool scatters = !reflection_;
    if (scatters &&
        (scratch_->phase_cumulative.empty() || !(scratch_->phase_cumulative.back() > 0)))
        return 0;
    const int of_guides = guides_->all().empty() ? 0 : k_direction.candidates_per_technique;
    const int of_local = 2 * k_direction.candidates_per_technique - of_guides;
    const EmissionSampler& emission = tables_->emission;
    const bool is_lit = scatters && !emission.empty();
    const int of_emission = is_lit ? k_direction.candidates_of_emission : 0;
    const double u_emission = is_lit ? random.next() : 0, v_emission = is_lit ? random.next() : 0,
                 w_emission = is_lit ? random.next() : 0;
    for (int k = -of_emission; k < of_guides + of_local; ++k) {
        Scratch::Candidate candidate;
        if (k < 0) {
            candidate.direction =
                emission.sample(x_, (-1 - k + u_emission) / of_emission,
                                wrapped(v_emission - k * k_direction.golden),
                                wrapped(w_emission - k * k_direction.golden * k_direction.golden));
        } else if (k < of_guides) {
            candidate.direction = guides_->sample((k + u_guide) / of_guides,
                                                  wrapped(azimuth_guide + k * k_direction.golden));
        } else {
            const int i = k - of_guides;
            candidate.direction =
                sample_local(wrapped(u_local + i * k_direction.golden), (i + v_local) / of_local,
                             wrapped(u_local + azimuth_guide +
                                     i * k_direction.golden * k_direction.golden + 0.5));
        }
        const Vector3& direction = candidate.direction;
        if (!scatters && glm::dot(scratch_->surface.hit.geometric_normal, direction) <= 0) continue;
        const double local = local_pdf(direction);
        const GuidingDistribution::Towards guide = guides_->towards(direction);
        const EmissionSampler::Towards emitted =
            is_lit ? emission.towards({x_, direction}) : EmissionSampler::Towards{};
        candidate.density = of_local * local + of_guides * guide.pdf + of_emission * emitted.pdf;
        candidate.response =
            scatters ? scratch_->phase_cumulative.back() * local : reflected(direction);
        candidate.of_particles = tables_->particles.along({x_, direction}, k_far);
        candidate.radiance = guide.radiance + candidate.of_particles + expected.ambient;
        candidate.emitted = emitted.radiance;
        candidate.radiance += emitted.radiance;
        if (expected.of_surface > 0 && glm::dot(expected.normal, direction) < 0)
            candidate.radiance += expected.of_surface;
        if (!(candidate.density > 0) || !(candidate.weight() > 0)) continue;
        candidates.push_back(candidate);
    }
    return sum_of_weights(candidates, k_direction.min_relative_radiance);
}

// f of a reflection, summed over the bands with the throughput.
double DirectionSampler::reflected(const Vector3& direction) const {
    Spectrum values;
    eval(direction, values);
    double sum = 0;
    for (std::size_t b = 0; b < tables_->optics.bands(); ++b) sum += throughput_[b] * values[b];
    return sum;
}

// A direction in proportion to f, or nearly so.
Vector3 DirectionSampler::sample_local(double u, double v, double azimuth) const {
    if (!reflection_) {
        const HalfTangentDensity& phase =
            tables_->scattering.directions[choose(scratch_->phase_cumulative, u).index];
        return direction_around(incoming_, phase.sample(v), azimuth);
    }
    const Vector3& normal = scratch_->surface.hit.normal;
    if (!reflection_->is_glossy() || u >= k_direction.specular_probability)
        return cosine_direction(normal, v, azimuth);
    const double h = sample_half_vector(v, reflection_->roughness());
    const Vector3 half = direction_around(normal, h, azimuth);
    return glm::normalize(incoming_ - 2 * glm::dot(incoming_, half) * half);
}

// The density of sample_local [1/sr].
double DirectionSampler::local_pdf(const Vector3& direction) const {
    if (!reflection_) {
        const std::span<const double> cumulative = scratch_->phase_cumulative;
        const double h = half_tangent_between(incoming_, direction);
        double sum = 0, before = 0;
        for (std::size_t m = 0; m < cumulative.size(); ++m) {
            const HalfTangentDensity& phase = tables_->scattering.directions[m];
            sum += (cumulative[m] - before) / phase.mass() * phase.density(h);
            before = cumulative[m];
        }
        return before > 0 ? sum / before * per_solid_angle(h) : 0.0;
    }
    const Vector3& normal = scratch_->surface.hit.normal;
    const double cosine = std::max(0.0, glm::dot(normal, direction)) * std::numbers::inv_pi;
    if (!reflection_->is_glossy()) return cosine;
    return (1 - k_direction.specular_probability) * cosine +
           k_direction.specular_probability *
               half_vector_density(normal, -incoming_, direction, reflection_->roughness());
}

// f by band [1/m/sr, 1/sr].
void DirectionSampler::eval(const Vector3& direction, Spectrum& values) const {
    const std::size_t bands = tables_->optics.bands();
    if (!reflection_) {
        std::vector<double>& p = scratch_->phase;
        p.resize(tables_->scattering.phase_count());
        tables_->scattering.phase(half_tangent_between(incoming_, direction), p);
        for (std::size_t b = 0; b < bands; ++b) {
            values[b] = 0;
            for (std::size_t m = 0; m < p.size(); ++m) values[b] += scattering_[m][b] * p[m];
        }
        return;
    }
    const double cosine = std::max(0.0, glm::dot(scratch_->surface.hit.normal, direction));
    reflection_->brdf_towards(direction, values);
    for (double& value : values.first(bands)) value *= cosine;
}

}  // namespace uw
