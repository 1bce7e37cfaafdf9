#include "core/paths/path_vertex.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/geometry/surface_reflection.h"
#include "core/paths/scattering_tables.h"

namespace uw {

namespace {

// A lamp that shines elsewhere still fills the water around it with scattered light.
constexpr double k_least_relative = 0.1;
constexpr double k_least_radius = 0.01;       // m: keeps it finite at a lamp
constexpr double k_least_attenuation = 1e-3;  // 1/m: keeps it finite in water without any

// The lamp's distance and its relative intensity over that.
struct Nearness {
    double radius = 0, relative = 0;

    Nearness(const Lamp& lamp, const Point3& x, double attenuation) {
        const Vector3 from_lamp = x - lamp.origin(x);
        radius = std::max(glm::length(from_lamp), k_least_radius);
        // A sun's light comes back from as far as one sees, a lamp's from around it.
        const double depth =
            lamp.sunlight() ? 1 / std::max(attenuation, k_least_attenuation) : radius;
        relative = std::max(lamp.relative_intensity(from_lamp), k_least_relative) * depth /
                   lamp.spread(radius);
    }
};

}  // namespace

double LampGlow::clearest() const {
    return optics_.attenuation().uniform[optics_.clearest_band()];
}

LampGlow::Spread LampGlow::spread(std::size_t lamp, const LampPassage& passage, double s,
                                  const Point3& x) const {
    const Nearness near((*optics_.scene().emitters)[lamp], x, clearest());
    const double h = passage.half_tangent(s, near.radius);
    return {near.relative * tables_.spread_glow(h), near.radius};
}

double LampGlow::of_lamp(std::size_t lamp, const Point3& x, const Spectrum& weights) const {
    const Lamp& source = (*optics_.scene().emitters)[lamp];
    const Nearness near(source, x, clearest());
    return near.relative * optics_.attenuated_sum(weights, source.axis_intensity(), near.radius);
}

namespace {

constexpr double k_glossy_share = 0.5;  // of the directions drawn on glossy surfaces

// The direction at tan(angle / 2) = h from `axis`.
Vector3 direction_around(const Vector3& axis, double h, double azimuth) {
    const auto [u, v] = Tangents(axis);
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
    return std::max(1e-16, std::sqrt(glm::dot(difference, difference) / square));
}

// From a density per h, at any azimuth, to one per solid angle:
// dOmega = 2 pi sin(psi) dpsi = 8 pi h / (1 + h^2)^2 dh.
double per_solid_angle(double h) {
    const double square = 1 + h * h;
    return square * square / (8 * std::numbers::pi * h);
}

Vector3 cosine_direction(const Vector3& normal, double u, double azimuth) {
    return direction_around(normal, std::sqrt(u) / (1 + std::sqrt(1 - u)), azimuth);
}

}  // namespace

std::optional<Vector3> scatter_plainly(const ScatteringTables& tables, const WaterPoint& point,
                                       const Vector3& direction, PathRandom& random,
                                       std::span<double> throughput) {
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

void PathVertex::scatter(const VertexTables& tables, const Point3& x, const Vector3& direction,
                         const WaterPoint& point, const Spectrum& throughput) {
    tables_ = tables;
    x_ = x;
    incoming_ = direction;
    point_ = &point;
    segment_ = nullptr;
    phase_cumulative_.clear();
    double total = 0;
    for (const Spectrum& b : point.scattering) {
        for (std::size_t band = 0; band < tables_.optics->bands(); ++band)
            total += throughput[band] * b[band];
        phase_cumulative_.push_back(total);
    }
    find_lobes(throughput);
}

void PathVertex::reflect(const VertexTables& tables, const WaterSegment& segment,
                         const Spectrum& throughput) {
    tables_ = tables;
    x_ = segment.hit.position;
    incoming_ = segment.ray.direction;
    point_ = nullptr;
    segment_ = &segment;
    sample_.emplace(SurfaceSample{segment.ray, segment.hit, 0, 0});
    reflection_.emplace(*tables_.optics->scene().surfaces, *sample_,
                        static_cast<int>(tables_.optics->bands()));
    find_lobes(throughput);
}

void PathVertex::find_lobes(const Spectrum& throughput) {
    lobes_.clear();
    lobe_cumulative_.clear();
    if (!(tables_.scattering->lobe.mass() > 0)) return;
    const std::vector<Lamp>& lamps = *tables_.optics->scene().emitters;
    const double scattering = scattering_around();
    const double attenuation =
        tables_.optics->attenuation().uniform[tables_.optics->clearest_band()];
    double total = 0;
    for (std::size_t j = 0; j < lamps.size(); ++j) {
        const Vector3 to_lamp = lamps[j].origin(x_) - x_;
        const double radius = glm::length(to_lamp);
        if (!(radius > 0) || (segment_ && glm::dot(segment_->hit.normal, to_lamp) <= 0)) continue;
        const double weight = tables_.glow->of_lamp(j, x_, throughput);
        if (!(weight > 0)) continue;
        total += weight;
        const double again = scattering * std::min(radius, 1 / std::max(attenuation, 1e-9));
        lobes_.push_back({j, to_lamp / radius, scattering * weight, again});
        lobe_cumulative_.push_back(total);
    }
}

std::optional<DrawnLobe> PathVertex::draw_lobe(PathRandom& random) const {
    double u = random.next();
    const double v = random.next(), azimuth = random.next();
    if (lobes_.empty()) return std::nullopt;
    const Choice chosen = choose(lobe_cumulative_, u);
    const Lobe& lobe = lobes_[chosen.index];
    const Vector3 direction = direction_around(
        lobe.direction, tables_.scattering->lobe.invert(v * tables_.scattering->lobe.mass()),
        azimuth);
    if (segment_ && glm::dot(segment_->hit.geometric_normal, direction) <= 0) return std::nullopt;
    const double h = half_tangent_between(lobe.direction, direction);
    return DrawnLobe{lobe.lamp, direction,
                     chosen.probability * tables_.scattering->lobe.density(h) /
                         tables_.scattering->lobe.mass() * per_solid_angle(h)};
}

void PathVertex::lobe_densities(const Vector3& direction, std::vector<double>& densities) const {
    densities.assign(tables_.optics->scene().emitters->size(), 0.0);
    double before = 0;
    for (std::size_t i = 0; i < lobes_.size(); ++i) {
        const double h = half_tangent_between(lobes_[i].direction, direction);
        const double probability = (lobe_cumulative_[i] - before) / lobe_cumulative_.back();
        before = lobe_cumulative_[i];
        densities[lobes_[i].lamp] = probability * tables_.scattering->lobe.density(h) /
                                    tables_.scattering->lobe.mass() * per_solid_angle(h);
    }
}

std::optional<DrawnDirection> PathVertex::draw(PathRandom& random) const {
    double u = random.next();
    const double v = random.next(), azimuth = random.next();
    DrawnDirection drawn;
    if (point_) {
        // Water may hold nothing that scatters.
        if (phase_cumulative_.empty() || !(phase_cumulative_.back() > 0)) return std::nullopt;
        const HalfTangentDensity& phase =
            tables_.scattering->directions[choose(phase_cumulative_, u).index];
        drawn.direction = direction_around(incoming_, phase.invert(v * phase.mass()), azimuth);
    } else {
        const SurfaceHit& hit = segment_->hit;
        if (reflection_->is_glossy() && u < k_glossy_share) {
            const double h = sample_half_vector(v, reflection_->roughness());
            const Vector3 half = direction_around(hit.normal, h, azimuth);
            drawn.direction = glm::normalize(incoming_ - 2 * glm::dot(incoming_, half) * half);
        } else {
            drawn.direction = cosine_direction(hit.normal, v, azimuth);
        }
        if (glm::dot(hit.geometric_normal, drawn.direction) <= 0) return std::nullopt;
    }
    drawn.density = density(drawn.direction);
    if (!(drawn.density > 0)) return std::nullopt;
    return drawn;
}

double PathVertex::density(const Vector3& direction) const {
    if (point_) {
        const double h = half_tangent_between(incoming_, direction);
        double sum = 0, before = 0;
        for (std::size_t m = 0; m < phase_cumulative_.size(); ++m) {
            const HalfTangentDensity& phase = tables_.scattering->directions[m];
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

// b [1/m], mean over the bands.
double PathVertex::scattering_around() const {
    double sum = 0;
    const auto include = [&](std::span<const Spectrum> coefficients) {
        for (const Spectrum& b : coefficients)
            for (std::size_t band = 0; band < tables_.optics->bands(); ++band) sum += b[band];
    };
    include(point_ ? point_->scattering : tables_.optics->scene().medium->uniform.scattering);
    return sum / static_cast<double>(tables_.optics->bands());
}

double PathVertex::expected_light(const Vector3& direction) const {
    double sum = 0;
    for (const Lobe& lobe : lobes_)
        sum += lobe.glow * lobe.again *
               tables_.scattering->spread_glow(half_tangent_between(lobe.direction, direction));
    return sum;
}

void PathVertex::respond(const Vector3& direction, Spectrum& values) const {
    const std::size_t bands = tables_.optics->bands();
    if (point_) {
        thread_local std::vector<double> p;
        p.resize(tables_.scattering->phase_count());
        tables_.scattering->phase(half_tangent_between(incoming_, direction), p);
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
