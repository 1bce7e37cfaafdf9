#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "core/base/vector_math.h"

/// Light by counting photons, with nothing in common with core/paths but vectors: an independent
/// witness. Photons leave the lamp and go straight to their next collision, found by delta tracking
/// in a cloud of Gaussian density; there they are absorbed or scattered by Henyey and Greenstein's
/// law; at surfaces, all in closed form, they are absorbed or reflected by Lambert's.
namespace uw::test {

class AnaloguePhotons {
  public:
    struct Optics {
        double absorption = 0, scattering = 0, g = 0;  // [1/m], [1/m], mean cosine
        double attenuation() const { return absorption + scattering; }
    };
    /// `peak` exp(-r^2 / 2 sigma^2) is added to the water.
    struct Cloud {
        Point3 center;
        double sigma = 1;
        Optics peak;
    };
    struct Box {
        Point3 min, max;
        double reflectance = 0;
    };
    /// The plane z = `z`, with water on the side of smaller z.
    struct Wall {
        double z = std::numeric_limits<double>::infinity();
        double reflectance = 0;
    };
    /// Emits cos^`exponent` of the angle from `axis`, in the half-space before it; all directions
    /// alike without one.
    struct Source {
        Point3 position;
        Vector3 axis{0};
        double exponent = 0;
    };
    struct Sphere {
        Point3 center;
        double radius = 0;
    };
    struct Scene {
        Optics water;
        Cloud cloud;
        Box box;
        Wall wall;
        Source source;
        std::vector<Sphere> detectors;
        double reach = 30;  // photons farther from the origin are given up [m]
    };

    /// Mean fluence in each detector by the number of scatterings and of reflections, the last of
    /// each for all beyond, for a source that emits 1 W [W/m^2].
    static constexpr int k_scatterings = 4, k_reflections = 3;
    using Fluence = std::vector<std::array<std::array<double, k_reflections>, k_scatterings>>;

    AnaloguePhotons(const Scene& scene, std::uint64_t seed) : scene_(scene), engine_(seed) {}

    /// By the lengths of the paths of `photons` photons in the detectors.
    Fluence count(int photons) {
        fluence_.assign(scene_.detectors.size(), {});
        for (int n = 0; n < photons; ++n) follow_one();
        for (std::size_t i = 0; i < fluence_.size(); ++i) {
            const double radius = scene_.detectors[i].radius;
            const double volume = 4 / 3.0 * std::numbers::pi * radius * radius * radius;
            for (auto& row : fluence_[i])
                for (double& length : row) length /= photons * volume;
        }
        return fluence_;
    }

  private:
    double uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }  // in [0, 1)

    /// A direction at `cosine` of the angle from `axis`, at a random azimuth.
    Vector3 around(const Vector3& axis, double cosine) {
        const double azimuth = 2 * std::numbers::pi * uniform();
        const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
        const Vector3 other = std::abs(axis.x) < 0.7 ? Vector3(1, 0, 0) : Vector3(0, 1, 0);
        const Vector3 u = glm::normalize(glm::cross(axis, other)), v = glm::cross(axis, u);
        return glm::normalize(sine * std::cos(azimuth) * u + sine * std::sin(azimuth) * v +
                              cosine * axis);
    }

    double scattering_cosine(double g) {
        const double u = uniform();
        if (g == 0) return 1 - 2 * u;
        const double root = (1 - g * g) / (1 - g + 2 * g * u);
        return (1 + g * g - root * root) / (2 * g);
    }

    Vector3 emitted_direction() {
        const Source& source = scene_.source;
        if (source.axis == Vector3(0)) return around({0, 0, 1}, 1 - 2 * uniform());
        return around(source.axis, std::pow(1 - uniform(), 1 / (source.exponent + 1)));
    }

    double cloud_density(const Point3& x) const {
        const Vector3 v = x - scene_.cloud.center;
        return std::exp(-0.5 * glm::dot(v, v) / (scene_.cloud.sigma * scene_.cloud.sigma));
    }

    struct Crossing {
        double distance = std::numeric_limits<double>::infinity();
        Vector3 normal{0};  // against the photon's direction
        double reflectance = 0;
    };

    Crossing next_surface(const Point3& x, const Vector3& d) const {
        Crossing first;
        if (d.z > 0) first = {(scene_.wall.z - x.z) / d.z, {0, 0, -1}, scene_.wall.reflectance};
        // The box lies between three pairs of planes; it is entered through the last of the three
        // that are entered, and missed if one has been left before.
        double enter = -std::numeric_limits<double>::infinity(), leave = -enter;
        Vector3 normal{0};
        for (int axis = 0; axis < 3; ++axis) {
            const double low = scene_.box.min[axis] - x[axis],
                         high = scene_.box.max[axis] - x[axis];
            if (d[axis] == 0) {
                if (low > 0 || high < 0) return first;
                continue;
            }
            const double in = (d[axis] > 0 ? low : high) / d[axis];
            if (in > enter) {
                enter = in;
                normal = Vector3(0);
                normal[axis] = d[axis] > 0 ? -1 : 1;
            }
            leave = std::min(leave, (d[axis] > 0 ? high : low) / d[axis]);
        }
        // A photon that has just left the box's face starts on it, up to rounding.
        if (enter < leave && enter > 1e-9 && enter < first.distance)
            first = {enter, normal, scene_.box.reflectance};
        return first;
    }

    /// Counts the part of a photon's way that lies in the detectors.
    void count_way(const Point3& x, const Vector3& d, double length, int scatterings,
                   int reflections) {
        for (std::size_t i = 0; i < scene_.detectors.size(); ++i) {
            const Sphere& sphere = scene_.detectors[i];
            const Vector3 v = sphere.center - x;
            const double along = glm::dot(v, d);
            const double half2 = sphere.radius * sphere.radius - glm::dot(v, v) + along * along;
            if (half2 <= 0) continue;
            const double half = std::sqrt(half2);
            const double inside = std::min(length, along + half) - std::max(0.0, along - half);
            if (inside > 0)
                fluence_[i][static_cast<std::size_t>(std::min(scatterings, k_scatterings - 1))]
                        [static_cast<std::size_t>(std::min(reflections, k_reflections - 1))] +=
                    inside;
        }
    }

    /// What happens to a photon at the end of a straight part of its way.
    enum class Event { absorbed, scattered, reflected };

    void follow_one() {
        Point3 x = scene_.source.position;
        Vector3 d = emitted_direction();
        int scatterings = 0, reflections = 0;
        while (glm::length(from_origin(x)) < scene_.reach) {
            const Point3 start = x;
            const Vector3 way = d;
            const Event event = go_on(x, d);
            count_way(start, way, distance(start, x), scatterings, reflections);
            if (event == Event::absorbed) return;
            ++(event == Event::scattered ? scatterings : reflections);
        }
    }

    /// Moves a photon to its next collision or surface and turns it there.
    Event go_on(Point3& x, Vector3& d) {
        const Optics &water = scene_.water, &peak = scene_.cloud.peak;
        const Crossing surface = next_surface(x, d);
        const double majorant = water.attenuation() + peak.attenuation();
        const Point3 start = x;
        double s = 0;
        while (true) {
            s -= std::log(1 - uniform()) / majorant;
            if (s >= surface.distance) {
                x = start + surface.distance * d;
                if (uniform() >= surface.reflectance) return Event::absorbed;
                d = around(surface.normal, std::sqrt(1 - uniform()));
                return Event::reflected;
            }
            x = start + s * d;
            if (s > 2 * scene_.reach) return Event::absorbed;  // gone
            // One interval of [0, majorant) for each fate; what is left is no collision.
            const double density = peak.attenuation() > 0 ? cloud_density(x) : 0;
            double u = uniform() * majorant;
            if ((u -= water.scattering) < 0) {
                d = around(d, scattering_cosine(water.g));
                return Event::scattered;
            }
            if ((u -= density * peak.scattering) < 0) {
                d = around(d, scattering_cosine(peak.g));
                return Event::scattered;
            }
            if ((u -= water.absorption + density * peak.absorption) < 0) return Event::absorbed;
        }
    }

    Scene scene_;
    std::mt19937_64 engine_;
    Fluence fluence_;
};

}  // namespace uw::test
