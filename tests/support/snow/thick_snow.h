#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/support/snow/snow_scene.h"

/// Images of thick marine snow, and their mean over seeds.
namespace uw::test {

/// A thick snow that the coefficients hold: nearly half of what they scatter at right angles, a
/// third of what they take away.
inline SceneDesc thick_scene() {
    SceneDesc desc = pinhole_scene(40, 30);
    desc.water = hg_water(0);
    SnowDesc snow;
    snow.number = 3e5;
    snow.least = 4e-4;
    snow.greatest = 4e-3;
    snow.exponent = 4;
    snow.reflectance = {0.7, 0.6, 0.5};
    desc.water.snow = snow;
    desc.geometry = {plane_at_z(2.5)};
    desc.lamps = {isotropic_lamp({0.4, -0.3, 0.1}, 40)};
    return desc;
}

inline double mean_of(const Film& film, std::size_t channel) {
    double sum = 0;
    for (int y = 0; y < film.height(); ++y)
        for (int x = 0; x < film.width(); ++x)
            sum += static_cast<double>(film.pixel(x, y)[channel]);
    return sum / (film.width() * film.height());
}

/// The mean over seeds is the image of the same coefficients without particles: within four
/// standard errors, and half a per cent for what single particles hide of the water's light, of
/// which the fraction behind them is interpolated over the image and the same for all bands.
inline void expect_mean(SceneDesc desc, const SceneDesc& without) {
    const Film smooth = image_of(without, {.layers = "total"});
    constexpr int k_seeds = 150;
    std::array<double, 3> sum{}, squares{};
    Renderer renderer;  // one, which keeps what seeds do not change: the lamp's light
    for (int seed = 0; seed < k_seeds; ++seed) {
        desc.water.snow->seed = static_cast<std::uint64_t>(seed);
        renderer.set_scene(SceneDesc(desc));
        const Film& film = renderer.render({.layers = "total"});
        for (std::size_t b = 0; b < 3; ++b) {
            const double value = mean_of(film, b) / mean_of(smooth, b);
            sum[b] += value;
            squares[b] += value * value;
        }
    }
    for (std::size_t b = 0; b < 3; ++b) {
        const double mean = sum[b] / k_seeds;
        const double error = std::sqrt((squares[b] / k_seeds - mean * mean) / (k_seeds - 1));
        EXPECT_LT(error, 5e-3) << "too few seeds to tell";
        EXPECT_NEAR(mean, 1, 4 * error + 5e-3) << "band " << b << ", error " << error;
    }
}

}  // namespace uw::test
