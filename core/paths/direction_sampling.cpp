#include "core/paths/direction_sampling.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/fast_exp.h"
#include "core/paths/choice.h"
#include "core/surfaces/microfacet.h"
#include "core/surfaces/surface_reflection.h"

namespace uw {

namespace {

// The probability of a lobe around a lamp instead of the phase function or BRDF.
constexpr double k_lobe_share = 0.5;
constexpr double k_glossy_share = 0.5;  // of the rest, on glossy surfaces
// A lamp that shines elsewhere still fills the water around it with scattered light.
constexpr double k_least_relative = 0.1;
constexpr double k_least_radius = 0.01;  // m: keeps weights finite at a lamp

// An orthonormal basis (Duff et al. 2017): the direction at tan(angle / 2) = h from `axis`.
Vector3 direction_around(const Vector3& axis, double h, double azimuth) {
    const double sign = std::copysign(1.0, axis.z);
    const double a = -1 / (sign + axis.z), b = axis.x * axis.y * a;
    const Vector3 u{1 + sign * axis.x * axis.x * a, sign * b, -sign * axis.x};
    const Vector3 v{b, sign + axis.y * axis.y * a, -axis.y};
    const double norm = 1 / (1 + h * h);
    const double sine = 2 * h * norm, cosine = (1 - h * h) * norm;
    const double phi = 2 * std::numbers::pi * azimuth;
    return glm::normalize(cosine * axis + sine * (std::cos(phi) * u + std::sin(phi) * v));
}

// tan(angle / 2) between unit vectors, accurate for small angles.
double half_tangent_between(const Vector3& a, const Vector3& b) {
    const Vector3 difference = a - b, sum = a + b;
    const double square = glm::dot(sum, sum);
    if (!(square > 1e-14)) return 1e7;  // opposite
    return std::sqrt(glm::dot(difference, difference) / square);
}

// From a density per h, integrated over the azimuth, to one per solid angle:
// dOmega = 2 pi sin(psi) dpsi = 8 pi h / (1 + h^2)^2 dh.
double per_solid_angle(double h) {
    const double square = 1 + h * h;
    return square * square / (8 * std::numbers::pi * h);
}

Vector3 cosine_direction(const Vector3& normal, double u, double azimuth) {
    const double sine = std::sqrt(u);
    const double h = sine / (1 + std::sqrt(1 - u));  // tan of half the angle
    return direction_around(normal, h, azimuth);
}

}  // namespace

/// The lamps that a vertex has lobes around.
struct DirectionSampling::Lobes {
    std::vector<Vector3> directions;
    std::vector<double> cumulative;  // of their weights
    bool empty() const { return cumulative.empty(); }
};

DirectionSampling::DirectionSampling(const WaterOptics& optics, const ScatteringTables& tables)
    : optics_(optics), tables_(tables) {}

void DirectionSampling::glow(const Point3& x, std::span<double> values) const {
    std::ranges::fill(values, 0.0);
    for (const Lamp& lamp : *optics_.scene().lamps) {
        const Vector3 from_lamp = x - lamp.position();
        const double radius = std::max(glm::length(from_lamp), k_least_radius);
        const double relative =
            std::max(lamp.relative_intensity(from_lamp), k_least_relative) / radius;
        for (std::size_t b = 0; b < values.size(); ++b)
            values[b] += relative * lamp.axis_intensity()[b] *
                         exp_of_minus(optics_.attenuation().uniform[b] * radius);
    }
}

// Lamps behind a surface with `normal` (or none, if null) have none.
void DirectionSampling::find_lobes(const Point3& x, const Spectrum& throughput,
                                   const Vector3* normal, Lobes& lobes) const {
    lobes.directions.clear();
    lobes.cumulative.clear();
    if (!(tables_.lobe.mass() > 0)) return;
    double total = 0;
    for (const Lamp& lamp : *optics_.scene().lamps) {
        const Vector3 to_lamp = lamp.position() - x;
        const double radius = glm::length(to_lamp);
        if (!(radius > 0) || (normal && glm::dot(*normal, to_lamp) <= 0)) continue;
        double weight = 1;
        if (optics_.scene().lamps->size() > 1) {
            weight = 0;
            for (std::size_t b = 0; b < optics_.bands(); ++b)
                weight += throughput[b] * lamp.axis_intensity()[b] *
                          exp_of_minus(optics_.attenuation().uniform[b] * radius);
            weight *= std::max(lamp.relative_intensity(-to_lamp), k_least_relative) /
                      std::max(radius, k_least_radius);
        }
        if (!(weight > 0)) continue;
        total += weight;
        lobes.directions.push_back(to_lamp / radius);
        lobes.cumulative.push_back(total);
    }
}

double DirectionSampling::lobe_density(const Lobes& lobes, const Vector3& direction) const {
    double density = 0, before = 0;
    for (std::size_t i = 0; i < lobes.directions.size(); ++i) {
        const double h = half_tangent_between(lobes.directions[i], direction);
        const double weight = lobes.cumulative[i] - before;
        before = lobes.cumulative[i];
        if (h > 0) density += weight * tables_.lobe.density(h) * per_solid_angle(h);
    }
    return density / (before * tables_.lobe.mass());
}

Vector3 DirectionSampling::sample_lobe(const Lobes& lobes, double u, double v,
                                       double azimuth) const {
    const std::size_t lamp = choose(lobes.cumulative, u).index;
    const double h = tables_.lobe.invert(v * tables_.lobe.mass());
    return direction_around(lobes.directions[lamp], h, azimuth);
}

Vector3 DirectionSampling::scatter(const Point3& x, const Vector3& direction,
                                   const WaterPoint& point, PathRandom& random,
                                   Spectrum& throughput) const {
    thread_local Lobes lobes;
    thread_local std::vector<double> cumulative, p;
    double u = random.next();
    const double v = random.next(), azimuth = random.next();
    const std::size_t phases = tables_.phase_count(), bands = optics_.bands();
    find_lobes(x, throughput, nullptr, lobes);
    const double lobe_share = lobes.empty() ? 0 : k_lobe_share;
    cumulative.assign(phases, 0.0);
    double total = 0;
    for (std::size_t m = 0; m < phases; ++m) {
        for (std::size_t b = 0; b < bands; ++b) total += throughput[b] * point.scattering[m][b];
        cumulative[m] = total;
    }
    Vector3 next;
    if (u < lobe_share) {
        next = sample_lobe(lobes, u / lobe_share, v, azimuth);
    } else {
        u = (u - lobe_share) / (1 - lobe_share);
        const HalfTangentDensity& phase = tables_.directions[choose(cumulative, u).index];
        next = direction_around(direction, phase.invert(v * phase.mass()), azimuth);
    }
    const double h = std::max(half_tangent_between(direction, next), 1e-16);
    double density = 0, before = 0;
    for (std::size_t m = 0; m < phases; ++m) {
        density += (cumulative[m] - before) / tables_.directions[m].mass() *
                   tables_.directions[m].density(h);
        before = cumulative[m];
    }
    density *= (1 - lobe_share) / total * per_solid_angle(h);
    if (lobe_share > 0) density += lobe_share * lobe_density(lobes, next);
    p.resize(phases);
    tables_.phase(h, p);
    for (std::size_t b = 0; b < bands; ++b) {
        double beta = 0;
        for (std::size_t m = 0; m < phases; ++m) beta += point.scattering[m][b] * p[m];
        throughput[b] = density > 0 ? throughput[b] * beta / density : 0.0;
    }
    return next;
}

std::optional<Vector3> DirectionSampling::reflect(const WaterSegment& segment, PathRandom& random,
                                                  Spectrum& throughput) const {
    thread_local Lobes lobes;
    double u = random.next();
    const double v = random.next(), azimuth = random.next();
    const SurfaceHit& hit = segment.hit;
    const SurfaceSample sample{segment.ray, hit, 0, 0};
    const std::size_t bands = optics_.bands();
    const SurfaceReflection reflection(*optics_.scene().surfaces, sample, static_cast<int>(bands));
    find_lobes(hit.position, throughput, &hit.normal, lobes);
    const double lobe_share = lobes.empty() ? 0 : k_lobe_share;
    const double glossy_share = reflection.is_glossy() ? (1 - lobe_share) * k_glossy_share : 0.0;
    const Vector3 to_camera = -segment.ray.direction;
    Vector3 next;
    if (u < lobe_share) {
        next = sample_lobe(lobes, u / lobe_share, v, azimuth);
    } else if (u < lobe_share + glossy_share) {
        const double h = sample_half_vector(v, reflection.roughness());
        const Vector3 half = direction_around(hit.normal, h, azimuth);
        next = glm::normalize(2 * glm::dot(to_camera, half) * half - to_camera);
    } else {
        next = cosine_direction(hit.normal, v, azimuth);
    }
    const double cosine = glm::dot(hit.normal, next);
    if (cosine <= 0 || glm::dot(hit.geometric_normal, next) <= 0) return std::nullopt;
    double density = (1 - lobe_share - glossy_share) * cosine * std::numbers::inv_pi;
    if (glossy_share > 0)
        density +=
            glossy_share * half_vector_density(hit.normal, to_camera, next, reflection.roughness());
    if (lobe_share > 0) density += lobe_share * lobe_density(lobes, next);
    Spectrum brdf;
    reflection.brdf_towards(next, brdf);
    for (std::size_t b = 0; b < bands; ++b) throughput[b] *= brdf[b] * cosine / density;
    return next;
}

}  // namespace uw
