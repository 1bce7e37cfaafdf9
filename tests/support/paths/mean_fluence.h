#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "core/light/integrator.h"
#include "core/light/medium.h"
#include "tests/support/paths/path_scene.h"
#include "tests/support/paths/term_sums.h"

namespace uw::test {

/// e^-tau between two points in one band, 0 where a surface lies between them.
inline double visible_transmittance(const LitScene& scene, std::size_t band, const Point3& a,
                                    const Point3& b) {
    if (scene.surfaces->occluded(a, b)) return 0;
    std::vector<double> columns(scene.medium->constituents.size());
    scene.field->column(a, b, columns);
    return std::exp(-AttenuationTable(*scene.medium).optical_depth(band, distance(a, b), columns));
}

/// Adds to `sums` what no path of the tracer brings of the light of `scene`'s only lamp along a ray
/// at which a diffuse surface lies: reflected once, never scattered.
inline void add_direct_light(const LitScene& scene, const Ray& ray, const SurfaceHit& hit,
                             double weight, TermSums& sums) {
    sums.set_weight(weight);
    const Lamp& lamp = scene.emitters->front();
    const Vector3 way = hit.position - lamp.position();
    const double r2 = glm::dot(way, way), cosine = -glm::dot(way, hit.normal) / std::sqrt(r2);
    if (cosine <= 0) return;
    const auto bands = static_cast<std::size_t>(scene.medium->band_count());
    std::vector<double> radiance(bands);
    for (std::size_t b = 0; b < bands; ++b)
        radiance[b] = lamp.axis_intensity()[b] * lamp.relative_intensity(way) * cosine / r2 *
                      visible_transmittance(scene, b, lamp.position(), hit.position) *
                      hit.reflectance[b] / std::numbers::pi *
                      visible_transmittance(scene, b, ray.origin, hit.position);
    sums.add({0, 0, 1, false, hit.distance, radiance});
}

/// The fluence of the lamp's unscattered light.
inline void add_unscattered(const LitScene& scene, const Point3& x, double weight, TermSums& sums) {
    const Lamp& lamp = scene.emitters->front();
    const Vector3 way = x - lamp.position();
    const auto bands = static_cast<std::size_t>(scene.medium->band_count());
    std::vector<double> fluence(bands);
    for (std::size_t b = 0; b < bands; ++b)
        fluence[b] = lamp.axis_intensity()[b] * lamp.relative_intensity(way) / glm::dot(way, way) *
                     visible_transmittance(scene, b, lamp.position(), x);
    sums.set_weight(weight);
    sums.add({0, 0, 0, false, 0, fluence});
}

/// A direction from which light arrives at a point, and the solid angle for which it stands.
struct FluenceDirection {
    Ray ray;
    double solid_angle = 0;
};

/// For `u` and `v` in [0, 1), which stand for all directions: the angle from that of `scene`'s only
/// lamp is pi u^2, since most light comes from there.
inline FluenceDirection fluence_direction(const LitScene& scene, const Point3& x, double u,
                                          double v) {
    constexpr double pi = std::numbers::pi;
    const Vector3 axis = glm::normalize(scene.emitters->front().position() - x);
    const Vector3 across = glm::normalize(
        glm::cross(axis, std::abs(axis.x) < 0.7 ? Vector3(1, 0, 0) : Vector3(0, 1, 0)));
    const double psi = pi * u * u, azimuth = 2 * pi * v;
    const Vector3 aside = std::cos(azimuth) * across + std::sin(azimuth) * glm::cross(axis, across);
    return {{x, glm::normalize(std::cos(psi) * axis + std::sin(psi) * aside)},
            4 * pi * pi * u * std::sin(psi)};
}

/// Adds an estimate of the fluence at `x` from all of the light of `scene`'s only lamp: that of one
/// direction (fluence_direction), by `paths` paths.
inline void add_fluence(const LitScene& scene, const PathTracer& tracer, const Point3& x, double u,
                        double v, std::uint64_t seed, std::uint32_t paths, double weight,
                        TermSums& sums) {
    const auto [ray, solid_angle] = fluence_direction(scene, x, u, v);
    trace_ray(tracer, *scene.surfaces, ray, seed, paths, sums, solid_angle * weight);
    SurfaceHit hit;
    if (scene.surfaces->closest_hit(ray, k_far, hit))
        add_direct_light(scene, ray, hit, solid_angle * weight, sums);
    add_unscattered(scene, x, weight, sums);
}

}  // namespace uw::test
