// ctest labels: unit analytic
// Waves that focus a sun: the closed form of long, low waves, what of the light is conserved, and
// how it moves.
#include "core/light/sun_focus.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "core/geometry/waves.h"
#include "core/light/lamp.h"
#include "core/scene/waves_desc.h"

namespace uw::test {
namespace {

using std::numbers::pi;

constexpr double k_n = 1.34;

WaterSurface surface_of(const WavesDesc& waves, double time = 0) {
    WaterSurfaceDesc desc{{0, 5, 0}, {0, 1, 0}, k_n};
    desc.waves = std::make_shared<const WavesDesc>(waves);
    return WaterSurface(desc, time);
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

WavesDesc breeze(double wind) {
    WavesDesc waves;
    WaveSpectrumDesc sea;
    sea.model = WaveSpectrumDesc::Model::jonswap;
    sea.wind = wind;
    sea.fetch = 1000;
    sea.tile = 10;
    sea.resolution = 128;
    sea.seed = 3;
    waves.shape = sea;
    return waves;
}

/// The map under these waves at a moment [s], read at places that lie between its texels.
class MapOfMoment {
  public:
    MapOfMoment(const WavesDesc& waves, double time)
        : focus_(surface_of(waves, time), glm::normalize(Vector3(0.3, -1, 0.2)), 0.01,
                 {.side = k_side, .is_periodic = true, .depth = 3}, k_texels) {}

    double at(double u, double v) const { return focus_.at({u, 5 - k_depth, v}); }

    static constexpr double k_side = 10, k_depth = 2;
    static constexpr int k_texels = 160;

  private:
    SunFocus focus_;
};

/// The root of the mean square of f(u, v) over a tile.
template <class Function>
double spread_of(const Function& f) {
    constexpr int k_places = 150;
    double squares = 0;
    for (int j = 0; j < k_places; ++j)
        for (int i = 0; i < k_places; ++i) {
            const double value = f((i + 0.3) * MapOfMoment::k_side / k_places,
                                   (j + 0.7) * MapOfMoment::k_side / k_places);
            squares += value * value;
        }
    return std::sqrt(squares) / k_places;
}

// A wave that travels takes its caustics with it, whatever part of a texel it has come: beams lie
// elsewhere on it then, but make the same light of it.
TEST(SunFocus, TravelsWithItsWave) {
    const double length = 2.5, k = 2 * pi / length;
    const WavesDesc waves = one_wave(0.1, length);
    const double speed = wave_frequency(k, {}) / k;
    const MapOfMoment before(waves, 0);
    const double contrast = spread_of([&](double u, double v) { return before.at(u, v) - 1; });
    EXPECT_GT(contrast, 0.2);
    const double texel = MapOfMoment::k_side / MapOfMoment::k_texels;
    for (const double texels : {0.25, 0.5, 9.37}) {
        const double way = texels * texel;
        const MapOfMoment after(waves, way / speed);
        const double change =
            spread_of([&](double u, double v) { return after.at(u + way, v) - before.at(u, v); });
        // What linear interpolation between texels leaves out: h''/8 of the texel's square.
        EXPECT_LT(change, 0.01 * contrast) << texels;
        EXPECT_GT(spread_of([&](double u, double v) { return after.at(u, v) - before.at(u, v); }),
                  3 * change);
    }
}

// From one moment to the next the map of a sea changes in proportion to the time between them, and
// by its square from a straight line: what flickers would change as much in any time.
TEST(SunFocus, DoesNotFlicker) {
    const WavesDesc waves = breeze(4);
    const MapOfMoment at_first(waves, 7);
    const auto moment = [&](double later) { return MapOfMoment(waves, 7 + later); };
    const auto change = [&](const MapOfMoment& to) {
        return spread_of([&](double u, double v) { return to.at(u, v) - at_first.at(u, v); });
    };
    const auto bend = [&](const MapOfMoment& earlier, const MapOfMoment& later) {
        return spread_of([&](double u, double v) {
            return earlier.at(u, v) + later.at(u, v) - 2 * at_first.at(u, v);
        });
    };
    constexpr double k_frame = 0.04;
    const double of_frame = change(moment(k_frame));
    double before = 0, bend_before = 0;
    for (const double step : {k_frame / 8, k_frame / 16, k_frame / 32}) {
        const MapOfMoment earlier = moment(-step), later = moment(step);
        const double by_now = change(later), bend_now = bend(earlier, later);
        if (before > 0) {
            EXPECT_NEAR(before / by_now, 2, 0.05) << step;
            EXPECT_GT(bend_before / bend_now, 3) << step;
        }
        before = by_now;
        bend_before = bend_now;
    }
    EXPECT_LT(before, of_frame / 8);
    EXPECT_GT(of_frame, 0.05);
}

// However waves focus it, light is neither lost nor gained on its way down.
TEST(SunFocus, KeepsTheLightThatEnters) {
    constexpr int k_resolution = 128;
    const SunFocus focus(surface_of(breeze(6)), glm::normalize(Vector3(0.5, -1, 0.2)), 0.01,
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

// The mean of what enters, summed here by Snell's and Fresnel's laws over slopes along x that are
// normally distributed, through the area that faces the sun.
TEST(SunFocus, LightTravelsAsTheSlopesRefractIt) {
    constexpr double k_amplitude = 0.06, k_wavelength = 2, k_altitude = 12;  // [degrees]
    const double deviation = 2 * pi / k_wavelength * k_amplitude / std::sqrt(2.0);
    const double altitude = k_altitude * pi / 180;
    const Vector3 in_air(std::cos(altitude), -std::sin(altitude), 0);
    const auto focus_at = [&](double time) {
        return SunFocus(surface_of(one_wave(k_amplitude, k_wavelength), time), in_air, 0,
                        {.side = 8, .is_periodic = true, .depth = 4}, 64);
    };
    const SunFocus focus = focus_at(0);
    Vector3 sum{0};
    const auto entering = [&](double slope) {
        const double tilt = std::atan(slope);  // the surface rises along x
        const double from_normal = pi / 2 - altitude - tilt;
        if (!(std::cos(from_normal) > 0)) return Vector3{0};
        const double refracted = std::asin(std::sin(from_normal) / k_n);
        const double s = std::sin(from_normal - refracted) / std::sin(from_normal + refracted);
        const double p = std::tan(from_normal - refracted) / std::tan(from_normal + refracted);
        const double flux = std::cos(from_normal) / std::cos(tilt) * (1 - (s * s + p * p) / 2);
        return flux * Vector3{std::sin(refracted + tilt), -std::cos(refracted + tilt), 0};
    };
    constexpr int k_slopes = 20000;
    for (int i = 0; i < k_slopes; ++i) {
        const double x = 12.0 * (i + 0.5) / k_slopes - 6;
        sum += std::exp(-0.5 * x * x) * entering(deviation * x);
    }
    const Vector3 mean = glm::normalize(sum);
    const Vector3 direction = focus.direction();
    // Its sum has 49 steps, and ends at 4.5 standard deviations.
    EXPECT_NEAR(glm::distance(direction, mean), 0, 1e-3);
    EXPECT_NEAR(glm::length(direction), 1, 1e-12);
    // Flatter than below calm water by some degrees.
    EXPECT_GT(direction.y, glm::normalize(entering(0)).y + 0.03);
    // What is known of the sun holds while waves move.
    EXPECT_EQ(focus_at(0.7).direction(), direction);

    // A level plane gets the same light as by calm water's direction.
    const Sunlight sunlight =
        Sunlight::from_air(in_air, WaterSurfaceDesc{{0, 5, 0}, {0, 1, 0}, k_n});
    Spectrum irradiance{};
    irradiance[0] = 3;
    const Lamp sun("sun", sunlight, irradiance);
    const Lamp focused = sun.focused(std::make_shared<SunFocus>(focus));
    EXPECT_NEAR(focused.axis_intensity()[0] * direction.y, 3 * sunlight.direction.y, 1e-9);
    EXPECT_NEAR(glm::distance(focused.sunlight()->direction, direction), 0, 1e-12);
}

}  // namespace
}  // namespace uw::test
