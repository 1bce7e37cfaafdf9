#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>

#include "core/base/vector_math.h"

/// Light paths as in a textbook, with nothing in common with core/paths but vectors: an independent
/// witness of whole images. In uniform water, one band; vertices and directions are those of
/// photons that go backwards, so that no path weighs more than another. What the water on a
/// straight part scatters is gathered at one point of it, and at one of a straight part that leads
/// elsewhere: towards the lamp, around which light grows as 1/R^2 (multiple importance sampling,
/// balance heuristic).
namespace uw::test {

class PlainPaths {
  public:
    struct Scene {
        double absorption = 0, scattering = 0, g = 0;  // [1/m], [1/m], mean cosine
        Point3 box_min, box_max;
        double wall_z = 0;       // a wall across z, seen from smaller z
        double reflectance = 0;  // of both
        Point3 lamp;             // isotropic
        double intensity = 0;    // [W/sr]
        double lamp_radius = 0;  // [m]; nothing is scattered inside
    };

    /// Radiance by the numbers of scatterings and of reflections, the last of each for all beyond,
    /// and by whether the last of all is a scattering.
    static constexpr int k_scatterings = 6, k_reflections = 3;
    using Kinds = std::array<std::array<std::array<double, 2>, k_reflections>, k_scatterings>;

    PlainPaths(const Scene& scene, std::uint64_t seed) : scene_(scene), engine_(seed) {}

    double uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }  // in [0, 1)

    /// Adds the light of one path that arrives at `x` against `d`.
    void trace(Point3 x, Vector3 d, Kinds& kinds) {
        const double c = scene_.absorption + scene_.scattering;
        double weight = 1;
        double water_weight = 1;  // of next-event estimation along `d`, against from_lobe
        int scatterings = 0, reflections = 0;
        bool begins_in_water = false;
        const auto add = [&](int more_scatterings, int more_reflections, double value) {
            const bool water =
                scatterings + reflections > 0 ? begins_in_water : more_scatterings > 0;
            const int s = std::min(scatterings + more_scatterings, k_scatterings - 1);
            const int r = std::min(reflections + more_reflections, k_reflections - 1);
            kinds[static_cast<std::size_t>(s)][static_cast<std::size_t>(r)][water ? 1 : 0] +=
                weight * value;
        };
        while (true) {
            const Hit hit = first_hit(x, d);
            add(1, 0, water_weight * from_water(x, d, hit.distance));
            if (hit.distance < k_infinity)
                add(0, 1, std::exp(-c * hit.distance) * from_surface(x + hit.distance * d, hit));
            const double way = -std::log(1 - uniform()) / c;
            if (way < hit.distance) {
                x = x + way * d;
                weight *= scene_.scattering / c;
                begins_in_water = begins_in_water || scatterings + reflections == 0;
                ++scatterings;
                const auto density = [&, before = d](const Vector3& w) {
                    return phase(glm::dot(before, w));
                };
                add(1, 0, from_lobe(x, density));
                d = around(d, scattering_cosine());
                water_weight = mis_weight(x, d, density);
            } else if (hit.distance < k_infinity) {
                x = x + hit.distance * d;
                weight *= scene_.reflectance;
                ++reflections;
                const auto density = [&](const Vector3& w) {
                    return std::max(0.0, glm::dot(hit.normal, w)) / std::numbers::pi;
                };
                add(1, 0, from_lobe(x, density));
                d = around(hit.normal, std::sqrt(1 - uniform()));
                water_weight = mis_weight(x, d, density);
            } else {
                return;
            }
            if (weight < 0.2) {
                if (uniform() >= 0.5) return;
                weight *= 2;
            }
        }
    }

  private:
    static constexpr double k_infinity = std::numeric_limits<double>::infinity();
    struct Hit {
        double distance = k_infinity;
        Vector3 normal{0};  // against the ray
    };

    /// Where a ray that starts outside of the box or on it meets a surface.
    Hit first_hit(const Point3& x, const Vector3& d) const {
        constexpr double k_skin = 1e-9;
        Hit first;
        if (d.z > 0 && scene_.wall_z - x.z > k_skin)
            first = {(scene_.wall_z - x.z) / d.z, {0, 0, -1}};
        double enter = -k_infinity, leave = k_infinity;
        Vector3 normal{0};
        for (int axis = 0; axis < 3; ++axis) {
            const double a = (scene_.box_min[axis] - x[axis]) / d[axis];
            const double b = (scene_.box_max[axis] - x[axis]) / d[axis];
            if (std::min(a, b) > enter) {
                enter = std::min(a, b);
                normal = Vector3(0);
                normal[axis] = d[axis] > 0 ? -1 : 1;
            }
            leave = std::min(leave, std::max(a, b));
        }
        if (enter < leave && enter > k_skin && enter < first.distance) first = {enter, normal};
        return first;
    }

    /// e^(-c R) / R^2 of the lamp times its intensity, 0 in shadow.
    double irradiance(const Point3& x) const {
        const double r = distance(x, scene_.lamp);
        if (first_hit(x, (scene_.lamp - x) / r).distance < r) return 0;
        return scene_.intensity / (r * r) * std::exp(-(scene_.absorption + scene_.scattering) * r);
    }

    double from_surface(const Point3& x, const Hit& hit) const {
        const Vector3 to_lamp = glm::normalize(scene_.lamp - x);
        const double cosine = glm::dot(to_lamp, hit.normal);
        return cosine > 0 ? scene_.reflectance / std::numbers::pi * cosine * irradiance(x) : 0;
    }

    /// Scattered once on a straight part, at one point. With D the lamp's distance from the line,
    /// ds / R^2 = dpsi / D for the angle psi between the line and the direction to the lamp: psi is
    /// drawn from a mixture of a uniform density and of one as wide as the forward peak.
    double from_water(const Point3& x, const Vector3& d, double length) {
        const Vector3 to_lamp = scene_.lamp - x;
        const double foot = glm::dot(to_lamp, d);
        const double lamp_distance = std::max(glm::length(to_lamp - foot * d), 1e-12);
        const double peak = (1 - scene_.g) / std::sqrt(std::max(scene_.g, 0.1));
        const double from = std::atan2(lamp_distance, foot);
        const double to =
            length < k_infinity ? std::atan2(lamp_distance, foot - length) : std::numbers::pi;
        const double peak_from = std::atan(from / peak), peak_to = std::atan(to / peak);
        const bool in_peak = uniform() < 0.5;
        const double u = uniform();
        const double psi = in_peak ? peak * std::tan(peak_from + u * (peak_to - peak_from))
                                   : from + u * (to - from);
        const double density =
            0.5 / (to - from) + 0.5 * peak / ((peak * peak + psi * psi) * (peak_to - peak_from));
        const double r = lamp_distance / std::sin(psi), s = foot - r * std::cos(psi);
        if (!(density > 0) || r < scene_.lamp_radius || s < 0 || s > length) return 0;
        const double attenuated = std::exp(-(scene_.absorption + scene_.scattering) * s);
        return scene_.scattering * phase(std::cos(psi)) * attenuated * r * r *
               irradiance(x + s * d) / (lamp_distance * density);
    }

    /// Angles psi to the lamp are drawn from a density ~ 1 / (psi + k_core).
    static constexpr double k_core = 0.02;
    double draw_lobe_angle() {
        return k_core * (std::pow(1 + std::numbers::pi / k_core, uniform()) - 1);
    }
    double lobe_density(const Point3& x, const Vector3& d) const {
        const Vector3 axis = glm::normalize(scene_.lamp - x);
        const double sine = std::max(glm::length(glm::cross(axis, d)), 1e-12);
        const double psi = std::atan2(sine, glm::dot(axis, d));
        return 1 / ((psi + k_core) * std::log(1 + std::numbers::pi / k_core) * 2 *
                    std::numbers::pi * sine);
    }
    /// The part of what comes along `d` that counts if `d` was drawn with `density`.
    template <class Density>
    double mis_weight(const Point3& x, const Vector3& d, const Density& density) const {
        return density(d) / (density(d) + lobe_density(x, d));
    }
    /// The other part, along a direction drawn for it.
    template <class Density>
    double from_lobe(const Point3& x, const Density& density) {
        const Vector3 d = around(glm::normalize(scene_.lamp - x), std::cos(draw_lobe_angle()));
        if (!(density(d) > 0)) return 0;
        return density(d) / (density(d) + lobe_density(x, d)) *
               from_water(x, d, first_hit(x, d).distance);
    }

    double phase(double cosine) const {
        const double q = 1 + scene_.g * scene_.g - 2 * scene_.g * cosine;
        return (1 - scene_.g * scene_.g) / (4 * std::numbers::pi * q * std::sqrt(q));
    }
    double scattering_cosine() {
        const double u = uniform(), g = scene_.g;
        if (g == 0) return 1 - 2 * u;
        const double root = (1 - g * g) / (1 - g + 2 * g * u);
        return (1 + g * g - root * root) / (2 * g);
    }
    Vector3 around(const Vector3& axis, double cosine) {
        const double azimuth = 2 * std::numbers::pi * uniform();
        const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
        const Vector3 other = std::abs(axis.x) < 0.7 ? Vector3(1, 0, 0) : Vector3(0, 1, 0);
        const Vector3 u = glm::normalize(glm::cross(axis, other)), v = glm::cross(axis, u);
        return glm::normalize(sine * std::cos(azimuth) * u + sine * std::sin(azimuth) * v +
                              cosine * axis);
    }

    Scene scene_;
    std::mt19937_64 engine_;
};

}  // namespace uw::test
