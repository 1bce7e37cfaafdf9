#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "render/snow/snow_model.h"
#include "tests/support/image_of.h"
#include "tests/support/test_scene.h"

/// Scenes of marine snow and what they show.
namespace uw::test {

inline constexpr double k_absorption = 0.1;  // 1/m, of clear_scene

/// Few particles, each of about a millimetre, in water that absorbs alone. Others that a narrow
/// view on one shows are far away: less than 1e-4 of its light.
inline SceneDesc clear_scene() {
    SceneDesc desc = pinhole_scene(64, 64);
    desc.camera.intrinsics = {2000, 2000, 32, 32};
    desc.water.absorption = PerBand{k_absorption, k_absorption, k_absorption};
    desc.water.scattering->b = {0, 0, 0};
    SnowDesc snow;
    snow.number = 0.01;
    snow.least = 1e-3;
    snow.greatest = 1.1e-3;
    snow.reflectance = {0.6, 0.5, 0.4};
    snow.seed = 5;
    snow.mean = SnowDesc::Mean::added;
    desc.water.snow = snow;
    desc.lamps = {isotropic_lamp({0.5, -0.3, -0.2}, 40)};
    return desc;
}

/// The particle nearest to a point.
inline SnowParticle particle_near(const SnowDesc& desc, const Point3& x) {
    const SnowField field(desc);
    SnowParticle nearest;
    double least = 1e9;
    for (std::size_t k = 0; k < field.classes().size(); ++k) {
        std::vector<SnowParticle> all;
        const double edge = field.classes()[k].edge;
        const auto cell = [&](double at) {
            return static_cast<std::int64_t>(std::floor(at / edge));
        };
        for (std::int64_t i = -1; i <= 1; ++i)
            for (std::int64_t j = -1; j <= 1; ++j)
                for (std::int64_t l = -1; l <= 1; ++l)
                    field.append_particles(k, {cell(x.x) + i, cell(x.y) + j, cell(x.z) + l}, 0,
                                           all);
        for (const SnowParticle& particle : all)
            if (distance(particle.position, x) < least) {
                least = distance(particle.position, x);
                nearest = particle;
            }
    }
    return nearest;
}

/// Places the camera, and the lamps fixed to it, so that it looks at the particle nearest to the
/// world's origin, which is then at `from_camera`, but for the roll.
inline SnowParticle aim(SceneDesc& desc, const Vector3& from_camera) {
    const SnowParticle particle = particle_near(*desc.water.snow, {});
    const Vector3 z = glm::normalize(from_camera), side = glm::normalize(glm::cross({0, 1, 0}, z));
    desc.camera.world_from_camera =
        Affine(Matrix3(side, glm::cross(z, side), z), from_origin(particle.position - from_camera));
    return particle;
}

inline Point3 centre_of(const SceneDesc& desc) {
    return at_origin_plus(desc.camera.world_from_camera.offset());
}
inline double range_of(const SnowParticle& particle, const SceneDesc& desc) {
    return distance(particle.position, centre_of(desc));
}

/// The image of what snow adds and takes away.
inline Film image_of(const SceneDesc& desc) {
    return image_of(desc, {.layers = "snow"});
}

/// The first band of the layer `snow` in images of nothing else.
inline constexpr std::size_t k_snow = 4;

/// A channel's sum, its centre and its variance along x [pixels^2] over an image.
struct Spot {
    double sum = 0, x = 0, y = 0, variance_x = 0;
};
inline Spot spot_of(const Film& film, std::size_t channel = k_snow) {
    Spot spot;
    double xx = 0;
    for (int y = 0; y < film.height(); ++y)
        for (int x = 0; x < film.width(); ++x) {
            const auto value = static_cast<double>(film.pixel(x, y)[channel]);
            spot.sum += value;
            spot.x += value * (x + 0.5);
            spot.y += value * (y + 0.5);
            xx += value * (x + 0.5) * (x + 0.5);
        }
    spot.x /= spot.sum;
    spot.y /= spot.sum;
    spot.variance_x = xx / spot.sum - spot.x * spot.x;
    return spot;
}

/// The sum over an image of pixels 1/focal wide of the radiance of one particle: of all that meets
/// its cross section it sends its reflectance as a diffuse sphere does.
inline double sum_of(const SnowParticle& particle, const SceneDesc& desc, std::size_t band) {
    const Point3 lamp = desc.camera.world_from_camera * desc.lamps[0].position;
    const Vector3 in = particle.position - lamp, out = centre_of(desc) - particle.position;
    const double radius = glm::length(in), range = glm::length(out);
    const double psi = std::acos(glm::dot(in, out) / radius / range);
    const double sphere =
        2 / (3 * std::numbers::pi * std::numbers::pi) * (std::sin(psi) - psi * std::cos(psi));
    const double area = std::numbers::pi / 4 * particle.diameter * particle.diameter;
    const double intensity = (*desc.lamps[0].intensity)[band] / (radius * radius) * area *
                             desc.water.snow->reflectance[band] * sphere;
    const double focal = desc.camera.intrinsics.fx;
    return intensity * std::exp(-k_absorption * (radius + range)) / (range * range) * focal * focal;
}

}  // namespace uw::test
