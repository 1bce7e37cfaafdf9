// ctest labels: unit analytic
// Waves that focus a sun: the closed form of long, low waves, and what of the light is conserved.
#include "core/light/sun_focus.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "core/scene/waves_desc.h"

namespace uw::test {
namespace {

using std::numbers::pi;

constexpr double k_n = 1.34;

WaterSurface surface_of(const WavesDesc& waves) {
    WaterSurfaceDesc desc{{0, 5, 0}, {0, 1, 0}, k_n};
    desc.waves = std::make_shared<const WavesDesc>(waves);
    return WaterSurface(desc);
}

WavesDesc one_wave(double amplitude, double wavelength) {
    WavesDesc waves;
    waves.shape = std::vector<SineWaveDesc>{{.amplitude = amplitude, .wavelength = wavelength}};
    return waves;
}

// Under a sun overhead a slope h' turns light by (1 - 1/n) h', to first order, towards where the
// surface rises: the light of u is at u + z (1 - 1/n) h'(u), and as much brighter as neighbours
// have come closer.
TEST(SunFocus, OfALowWaveIsTheClosedForm) {
    constexpr double k_amplitude = 0.002, k_wavelength = 2;
    const SunFocus focus(surface_of(one_wave(k_amplitude, k_wavelength)), {0, -1, 0}, 0,
                         {.side = 8, .is_periodic = true, .depth = 4}, 256);
    const double k = 2 * pi / k_wavelength;
    double largest = 0;
    for (const double z : {0.5, 1.0, 2.0, 4.0}) {
        for (double u = 0; u < k_wavelength; u += 0.1) {
            const double bend = z * (1 - 1 / k_n);
            // h = A cos ku, which is highest at u = 0.
            const double at = u - bend * k_amplitude * k * std::sin(k * u);
            const double truth = 1 / (1 - bend * k_amplitude * k * k * std::cos(k * u));
            largest = std::max(largest, std::abs(truth - 1));
            // Beams, nine per texel, and texels of 3 cm.
            EXPECT_NEAR(focus.at({at, 5 - z, 0.3}), truth, 1e-3 + 0.02 * std::abs(truth - 1));
        }
    }
    EXPECT_GT(largest, 0.01);
}

// However waves focus it, light is neither lost nor gained on its way down.
TEST(SunFocus, KeepsTheLightThatEnters) {
    WavesDesc waves;
    WaveSpectrumDesc sea;
    sea.model = WaveSpectrumDesc::Model::jonswap;
    sea.wind = 6;
    sea.fetch = 1000;
    sea.tile = 10;
    sea.resolution = 128;
    sea.seed = 3;
    waves.shape = sea;
    constexpr int k_resolution = 128;
    const SunFocus focus(surface_of(waves), glm::normalize(Vector3(0.5, -1, 0.2)), 0.01,
                         {.side = 10, .is_periodic = true, .depth = 6}, k_resolution);
    double at_surface = 0;
    for (const double depth : {0.0, 0.5, 2.0, 6.0}) {
        double mean = 0, squares = 0;
        for (int j = 0; j < k_resolution; ++j)
            for (int i = 0; i < k_resolution; ++i) {
                const double value = focus.at({(i + 0.5) * 10 / k_resolution, 5 - depth - 1e-9,
                                               (j + 0.5) * 10 / k_resolution});
                mean += value / (k_resolution * k_resolution);
                squares += value * value / (k_resolution * k_resolution);
            }
        if (depth == 0) at_surface = mean;
        // The lookup's places are not the texels', by the light's slope.
        EXPECT_NEAR(mean, at_surface, 0.01 * at_surface) << depth;
        if (depth == 2.0) {  // a net of caustics
            EXPECT_GT(squares / (mean * mean), 1.2);
        }
    }
    // Slopes of a few degrees change what enters by a few per cent.
    EXPECT_NEAR(at_surface, 1, 0.05);
}

}  // namespace
}  // namespace uw::test
