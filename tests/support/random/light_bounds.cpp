#include "tests/support/random/light_bounds.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace uw::test {
namespace {

constexpr double k_pi = std::numbers::pi;
constexpr double k_unknown = std::numeric_limits<double>::infinity();

double radians(double degrees) {
    return degrees * k_pi / 180;
}

/// The least solid angle [sr] into which the lamp would send its power, were it as bright in all of
/// it as it is at most.
double min_solid_angle(const LampProfileDesc& profile) {
    if (std::holds_alternative<IsotropicProfileDesc>(profile)) return 4 * k_pi;
    if (const auto* cosine = std::get_if<CosineProfileDesc>(&profile)) {
        const double power = std::log(0.5) / std::log(std::cos(radians(cosine->fwhm / 2)));
        return 2 * k_pi / (power + 1);
    }
    const auto* spot = std::get_if<SpotProfileDesc>(&profile);
    const bool is_full_within = spot && (spot->falloff == SpotProfileDesc::Falloff::smooth ||
                                         spot->falloff == SpotProfileDesc::Falloff::gltf);
    if (!is_full_within) return 0;
    const double half = std::sin(radians((spot->beam - spot->edge) / 4));
    return 4 * k_pi * half * half;  // 2 pi (1 - cos)
}

/// [W/sr], of a sun [W/m^2].
double max_intensity(const LampDesc& lamp, std::size_t band) {
    if (lamp.spectrum) return k_unknown;
    if (lamp.intensity) return (*lamp.intensity)[band];
    if (!lamp.power) return k_unknown;
    const double power = (*lamp.power)[band];
    const double angle = min_solid_angle(lamp.profile);
    return power == 0 ? 0 : angle > 0 ? power / angle : k_unknown;
}

Point3 position(const SceneDesc& scene, const LampDesc& lamp) {
    return lamp.world_from_frame(scene.camera.world_from_camera) * lamp.position;
}

/// From its centre to the farthest of its points [m].
double reach(const LampDesc& lamp) {
    if (!lamp.extent) return 0;
    return std::max(lamp.extent->radius, std::hypot(lamp.extent->width, lamp.extent->height) / 2);
}

}  // namespace

std::vector<double> max_irradiance(const SceneDesc& scene, const Point3& at, double error) {
    std::vector<double> most(scene.water.bands_nm.size());
    for (const LampDesc& lamp : scene.lamps) {
        double per_intensity = 1;
        if (!lamp.sun) {
            const double distance = glm::length(at - position(scene, lamp)) - reach(lamp) - error;
            per_intensity = distance > 0 ? 1 / (distance * distance) : k_unknown;
        }
        for (std::size_t band = 0; band < most.size(); ++band) {
            const double intensity = max_intensity(lamp, band);
            if (intensity > 0) most[band] += intensity * per_intensity;
        }
    }
    return most;
}

std::vector<double> max_radiance_of_lamps(const SceneDesc& scene) {
    std::vector<double> most(scene.water.bands_nm.size());
    for (const LampDesc& lamp : scene.lamps) {
        if (!lamp.extent) continue;
        const bool is_round = lamp.extent->shape != LampExtentDesc::Shape::rectangle;
        const double area = is_round ? k_pi * lamp.extent->radius * lamp.extent->radius
                                     : lamp.extent->width * lamp.extent->height;
        // A flat lamp has I(theta) / (A cos theta), which has no bound where I falls more slowly
        // than the cosine.
        const auto* cosine = std::get_if<CosineProfileDesc>(&lamp.profile);
        const bool is_bounded =
            lamp.extent->shape == LampExtentDesc::Shape::sphere || (cosine && cosine->fwhm <= 120);
        for (std::size_t band = 0; band < most.size(); ++band) {
            const double intensity = max_intensity(lamp, band);
            if (intensity > 0) most[band] += is_bounded ? intensity / area : k_unknown;
        }
    }
    return most;
}

std::optional<std::vector<double>> max_in_scatter(const SceneDesc& scene, const Ray& ray) {
    const WaterDesc& water = scene.water;
    if (!water.scattering || !water.absorption || !scene.volumes.empty() || water.snow)
        return std::nullopt;
    const auto* phase = std::get_if<HenyeyGreensteinDesc>(&water.scattering->phase.function);
    if (phase == nullptr) return std::nullopt;
    const double g = std::abs(phase->g);
    const double peak = (1 + g) / (4 * k_pi * (1 - g) * (1 - g));
    std::vector<double> most(water.bands_nm.size());
    for (const LampDesc& lamp : scene.lamps) {
        if (lamp.extent) return std::nullopt;
        const Vector3 to_lamp = position(scene, lamp) - ray.origin;
        const double foot = glm::dot(to_lamp, ray.direction);
        const double distance = glm::length(to_lamp - foot * ray.direction);
        // pi/2 + atan(f/h), of which nothing cancels for a ray that leads away from the lamp.
        const double angle = std::atan2(distance, -foot);
        const double length = distance > 0 ? angle / distance : foot < 0 ? -1 / foot : k_unknown;
        for (std::size_t band = 0; band < most.size(); ++band) {
            const double b = water.scattering->b[band];
            const double intensity = max_intensity(lamp, band);
            if (intensity <= 0 || b <= 0) continue;
            most[band] +=
                b * peak * intensity * (lamp.sun ? 1 / ((*water.absorption)[band] + b) : length);
        }
    }
    return most;
}

}  // namespace uw::test
