#include "core/frame/fine_beams.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/integrators/integrator.h"

namespace uw {

namespace {

// Wider ones are seen by any rays, but for their first centimetres.
constexpr double k_widest = 80 * std::numbers::pi / 180;
// The least angle from the axis that is told from it [rad], and the factor to the next one.
constexpr double k_narrowest = 1e-6, k_next_angle = 1.1;
constexpr int k_azimuths = 8;
// Beyond this many times the angle of half the intensity, a cosine has 0.02 % of it.
constexpr double k_outer = 3.5;
// By how much rays may bulge out of the planes through a rectangle's corners [pixels].
constexpr double k_bulge = 1;

// The greatest angle from the lamp's axis at which the intensity is half of the greatest one.
double core_angle(const Lamp& emitter, const Vector3& axis) {
    const Vector3 other = std::abs(axis.x) < 0.5 ? Vector3(1, 0, 0) : Vector3(0, 1, 0);
    const Vector3 u = glm::normalize(glm::cross(axis, other)), v = glm::cross(axis, u);
    const auto brightest = [&](double angle) {
        double most = 0;
        for (int k = 0; k < k_azimuths; ++k) {
            const double azimuth = 2 * std::numbers::pi * k / k_azimuths;
            const Vector3 aside = std::cos(azimuth) * u + std::sin(azimuth) * v;
            most = std::max(
                most, emitter.relative_intensity(std::cos(angle) * axis + std::sin(angle) * aside));
        }
        return most;
    };
    std::vector<std::pair<double, double>> intensities;  // by angle
    double most = 0;
    for (double angle = k_narrowest; angle < std::numbers::pi; angle *= k_next_angle) {
        intensities.emplace_back(angle, brightest(angle));
        most = std::max(most, intensities.back().second);
    }
    double core = k_narrowest;
    for (const auto& [angle, intensity] : intensities)
        if (intensity >= 0.5 * most) core = angle;
    return core;
}

// Reduces `part` to where slope * t <= most.
void clip(double slope, double most, Interval& part) {
    if (slope > 0)
        part.end = std::min(part.end, most / slope);
    else if (slope < 0)
        part.begin = std::max(part.begin, most / slope);
    else if (most < 0)
        part.end = part.begin - 1;
}

}  // namespace

FineBeams::FineBeams(const RaySource& rays, const std::vector<Lamp>& emitters) : rays_(rays) {
    std::optional<Beam> beam;
    for (std::size_t i = 0; i < emitters.size(); ++i) {
        const Lamp& emitter = emitters[i];
        if (emitter.sunlight()) continue;
        // The points of a lamp differ by their places alone.
        if (i == 0 || emitters[i - 1].index() != emitter.index()) beam = beam_of(emitter);
        if (!beam) continue;
        beam->apex = emitter.position();
        beams_.push_back(*beam);
    }
}

std::optional<FineBeams::Beam> FineBeams::beam_of(const Lamp& emitter) {
    const DirectionCone cone = emitter.cone();
    const double core = core_angle(emitter, cone.axis);
    if (core >= k_widest) return std::nullopt;
    double outer = k_outer * core;
    if (!cone.has_all()) outer = std::min(outer, std::max(core, std::acos(cone.cosine)));
    return Beam{{}, glm::normalize(cone.axis), std::tan(core), std::tan(std::min(outer, k_widest))};
}

std::optional<FineBeams::Bundle> FineBeams::bundle(const ImageRectangle& area) const {
    struct Position {
        double x, y;
    };
    const Position middle{0.5 * (area.x0 + area.x1), 0.5 * (area.y0 + area.y1)};
    const std::array<Position, 5> positions{
        {{area.x0, area.y0}, {area.x1, area.y0}, {area.x1, area.y1}, {area.x0, area.y1}, middle}};
    std::array<Ray, 5> rays;
    Bundle found;
    for (std::size_t k = 0; k < positions.size(); ++k) {
        const auto [x, y] = positions[k];
        // A pixel further, within the rectangle.
        const double dx = x > middle.x ? -1 : 1, dy = y > middle.y ? -1 : 1;
        const std::optional<Ray> ray = rays_.refracted_ray(x, y);
        const std::optional<Ray> beside = rays_.refracted_ray(x + dx, y + dy);
        if (!ray || !beside) return std::nullopt;
        rays[k] = *ray;
        found.pixel =
            std::max(found.pixel, glm::length(beside->direction - ray->direction) / std::sqrt(2.0));
    }
    found.origin = rays.back().origin;
    found.direction = rays.back().direction;
    for (std::size_t k = 0; k < found.outwards.size(); ++k) {
        const Ray &a = rays[k], &b = rays[(k + 1) % found.outwards.size()];
        Vector3 outwards = glm::normalize(glm::cross(a.direction, b.direction));
        if (glm::dot(outwards, found.direction) > 0) outwards = -outwards;
        found.outwards[k] = outwards;
        // Behind a port, rays do not come from one point.
        found.offsets[k] = std::max(glm::dot(outwards, from_origin(a.origin)),
                                    glm::dot(outwards, from_origin(b.origin)));
    }
    return found;
}

void FineBeams::begin(const ImageRectangle& area, double width, double reach) {
    near_.clear();
    reach_ = reach;
    if (beams_.empty()) return;
    const std::optional<Bundle> all = bundle(area);
    for (const Beam& beam : beams_)
        if (!all || is_fine_in(*all, beam, width)) near_.push_back(&beam);
}

bool FineBeams::has_any(const ImageRectangle& area, double width) const {
    if (near_.empty()) return false;
    const std::optional<Bundle> part = bundle(area);
    return !part || std::ranges::any_of(
                        near_, [&](const Beam* beam) { return is_fine_in(*part, *beam, width); });
}

// The beam at t metres from its lamp is a ball around the point there: each condition is linear.
bool FineBeams::is_fine_in(const Bundle& bundle, const Beam& beam, double width) const {
    const Vector3 to_apex = beam.apex - bundle.origin;
    // The distance of the point at t from the camera, along the ray in the middle: z + t * dz.
    const double z = glm::dot(bundle.direction, to_apex);
    const double dz = glm::dot(bundle.direction, beam.axis);
    Interval part{0, k_far};
    clip(-dz - beam.outer_slope, z, part);
    clip(dz - beam.outer_slope, reach_ - z, part);
    const double margin = k_bulge * bundle.pixel;
    for (std::size_t k = 0; k < bundle.outwards.size(); ++k) {
        const Vector3& outwards = bundle.outwards[k];
        clip(glm::dot(outwards, beam.axis) - beam.outer_slope - margin * dz,
             bundle.offsets[k] - glm::dot(outwards, from_origin(beam.apex)) + margin * z, part);
    }
    if (!(part.begin < part.end)) return false;
    const auto is_fine_at = [&](double t) {
        return 2 * beam.core_slope * t <
               width * bundle.pixel * glm::length(to_apex + t * beam.axis);
    };
    return is_fine_at(part.begin) || is_fine_at(part.end);
}

}  // namespace uw
