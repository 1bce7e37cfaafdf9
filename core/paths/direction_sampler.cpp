#include "core/paths/direction_sampler.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/geometry/surface_reflection.h"
#include "core/paths/scattering_tables.h"

namespace uw {

namespace {

constexpr double k_glossy_share = 0.5;  // of the directions drawn on glossy surfaces

Vector3 cosine_direction(const Vector3& normal, double u, double azimuth) {
    return direction_around(normal, std::sqrt(u) / (1 + std::sqrt(1 - u)), azimuth);
}

}  // namespace

std::optional<Vector3> sample_phase_function(const ScatteringTables& tables,
                                             const WaterPoint& point, const Vector3& direction,
                                             PathRandom& random, std::span<double> throughput) {
    thread_local std::vector<double> cumulative;
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
    return direction_around(direction, phase.invert(v * phase.mass()), azimuth);
}

void DirectionSampler::scatter(const GuidingTables& tables, const Point3& x,
                               const Vector3& direction, const WaterPoint& point,
                               const Spectrum& throughput) {
    tables_ = &tables;
    x_ = x;
    incoming_ = direction;
    point_ = &point;
    segment_ = nullptr;
    phase_cumulative_.clear();
    double total = 0;
    for (const Spectrum& b : point.scattering) {
        for (std::size_t band = 0; band < tables_->optics.bands(); ++band)
            total += throughput[band] * b[band];
        phase_cumulative_.push_back(total);
    }
    find_guides(throughput);
}

void DirectionSampler::reflect(const GuidingTables& tables, const WaterSegment& segment,
                               const Spectrum& throughput) {
    tables_ = &tables;
    x_ = segment.hit.position;
    incoming_ = segment.ray.direction;
    point_ = nullptr;
    segment_ = &segment;
    sample_.emplace(SurfaceSample{segment.ray, segment.hit, 0, 0});
    reflection_.emplace(*tables_->optics.scene().surfaces, *sample_,
                        static_cast<int>(tables_->optics.bands()));
    find_guides(throughput);
}

void DirectionSampler::find_guides(const Spectrum& throughput) {
    throughput_ = throughput;
    guides_.find(*tables_, x_, throughput);
    guide_cumulative_.clear();
    double total = 0;
    for (const GuidingDistribution::Guide& guide : guides_.all()) {
        total += guide.irradiance;
        guide_cumulative_.push_back(total);
    }
}

// Resampled importance sampling (Talbot et al. 2005): stratified, as many of each kind, weighted
// against each other by the balance heuristic.
double DirectionSampler::sample_candidates(PathRandom& random, const ExpectedRadiance& expected,
                                           std::vector<DirectionCandidate>& candidates) const {
    constexpr int k_of_each = 3;
    constexpr double k_golden = 0.6180339887498949;  // spreads azimuths evenly
    constexpr double k_min_light = 0.3;              // relative to the candidates' mean
    candidates.clear();
    const double u_lobe = random.next(), a_lobe = random.next();
    const double u_own = random.next(), v_own = random.next();
    if (point_ && (phase_cumulative_.empty() || !(phase_cumulative_.back() > 0))) return 0;
    const auto wrapped = [](double x) { return x - std::floor(x); };
    const std::span<const GuidingDistribution::Guide> guides = guides_.all();
    const int of_lobes = guides.empty() ? 0 : k_of_each, of_own = 2 * k_of_each - of_lobes;
    const LampRadianceTable& field = tables_->scattering.field();
    double sum = 0, responding = 0;
    for (int k = 0; k < of_lobes + of_own; ++k) {
        DirectionCandidate candidate;
        if (k < of_lobes) {
            double u = (k + u_lobe) / of_lobes;
            const GuidingDistribution::Guide& guide = guides[choose(guide_cumulative_, u).index];
            const HalfTangentDensity* lobe = &field.lobe(guide.place);
            if (guide.scattered_once > 0) {
                u *= 2;
                if (u >= 1) {
                    u -= 1;
                    lobe = &field.phase();
                }
            }
            candidate.direction = direction_around(guide.direction, lobe->invert(u * lobe->mass()),
                                                   wrapped(a_lobe + k * k_golden));
        } else {
            const int i = k - of_lobes;
            candidate.direction =
                sample_local(wrapped(u_own + i * k_golden), (i + v_own) / of_own,
                             wrapped(u_own + a_lobe + i * k_golden * k_golden + 0.5));
        }
        const Vector3& direction = candidate.direction;
        if (segment_ && glm::dot(segment_->hit.geometric_normal, direction) <= 0) continue;
        candidate.density =
            of_own * local_pdf(direction) + (of_lobes > 0 ? of_lobes * guide_pdf(direction) : 0);
        candidate.response = target_density(direction);
        candidate.of_particles = tables_->particles.along({x_, direction}, k_far);
        candidate.light = guides_.radiance(direction) + candidate.of_particles + expected.ambient;
        if (expected.of_surface > 0 && glm::dot(expected.normal, direction) < 0)
            candidate.light += expected.of_surface;
        if (!(candidate.density > 0) || !(candidate.weight() > 0)) continue;
        sum += candidate.weight();
        responding += candidate.response / candidate.density;
        candidates.push_back(candidate);
    }
    if (candidates.empty()) return 0;
    // None is guessed far darker than the mean: what shines there after all would be too bright.
    const double least = k_min_light * sum / responding;
    sum = 0;
    for (DirectionCandidate& candidate : candidates) {
        candidate.light = std::max(candidate.light, least);
        sum += candidate.weight();
    }
    return sum;
}

// The density of the lobes that candidates are drawn from [1/sr]: a sun has two, of which one is
// its light that is scattered once.
double DirectionSampler::guide_pdf(const Vector3& direction) const {
    const LampRadianceTable& field = tables_->scattering.field();
    double sum = 0, before = 0;
    for (std::size_t j = 0; j < guide_cumulative_.size(); ++j) {
        const GuidingDistribution::Guide& guide = guides_.all()[j];
        const HalfTangentDensity& lobe = field.lobe(guide.place);
        const double h = half_tangent_between(guide.direction, direction);
        double density = lobe.density(h) / lobe.mass();
        if (guide.scattered_once > 0)
            density = 0.5 * (density + field.phase().density(h) / field.phase().mass());
        sum += (guide_cumulative_[j] - before) * density * per_solid_angle(h);
        before = guide_cumulative_[j];
    }
    return sum / before;
}

// `respond`, summed over the bands with the throughput; of a scattering, by what directions are
// drawn from.
double DirectionSampler::target_density(const Vector3& direction) const {
    if (point_) return phase_cumulative_.back() * local_pdf(direction);
    Spectrum values;
    eval(direction, values);
    double sum = 0;
    for (std::size_t b = 0; b < tables_->optics.bands(); ++b) sum += throughput_[b] * values[b];
    return sum;
}

// In proportion to the phase function or BRDF.
Vector3 DirectionSampler::sample_local(double u, double v, double azimuth) const {
    if (point_) {
        const HalfTangentDensity& phase =
            tables_->scattering.directions[choose(phase_cumulative_, u).index];
        return direction_around(incoming_, phase.invert(v * phase.mass()), azimuth);
    }
    const Vector3& normal = segment_->hit.normal;
    if (!reflection_->is_glossy() || u >= k_glossy_share)
        return cosine_direction(normal, v, azimuth);
    const double h = sample_half_vector(v, reflection_->roughness());
    const Vector3 half = direction_around(normal, h, azimuth);
    return glm::normalize(incoming_ - 2 * glm::dot(incoming_, half) * half);
}

double DirectionSampler::local_pdf(const Vector3& direction) const {
    if (point_) {
        const double h = half_tangent_between(incoming_, direction);
        double sum = 0, before = 0;
        for (std::size_t m = 0; m < phase_cumulative_.size(); ++m) {
            const HalfTangentDensity& phase = tables_->scattering.directions[m];
            sum += (phase_cumulative_[m] - before) / phase.mass() * phase.density(h);
            before = phase_cumulative_[m];
        }
        return before > 0 ? sum / before * per_solid_angle(h) : 0.0;
    }
    const Vector3& normal = segment_->hit.normal;
    const double cosine = std::max(0.0, glm::dot(normal, direction)) * std::numbers::inv_pi;
    if (!reflection_->is_glossy()) return cosine;
    return (1 - k_glossy_share) * cosine +
           k_glossy_share *
               half_vector_density(normal, -incoming_, direction, reflection_->roughness());
}

void DirectionSampler::eval(const Vector3& direction, Spectrum& values) const {
    const std::size_t bands = tables_->optics.bands();
    if (point_) {
        thread_local std::vector<double> p;
        p.resize(tables_->scattering.phase_count());
        tables_->scattering.phase(half_tangent_between(incoming_, direction), p);
        for (std::size_t b = 0; b < bands; ++b) {
            values[b] = 0;
            for (std::size_t m = 0; m < p.size(); ++m) values[b] += point_->scattering[m][b] * p[m];
        }
        return;
    }
    const double cosine = std::max(0.0, glm::dot(segment_->hit.normal, direction));
    reflection_->brdf_towards(direction, values);
    for (double& value : values.first(bands)) value *= cosine;
}

}  // namespace uw
