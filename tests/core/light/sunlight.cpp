// ctest labels: analytic
// Lamps that are suns: parallel light that begins at the water's surface.
#include "core/light/lamp.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "core/light/lamp_factory.h"
#include "core/light/ray_panels.h"
#include "tests/support/random_direction.h"
#include "tests/support/suns.h"

namespace uw::test {
namespace {

constexpr std::array k_bands_nm{620.0, 540.0, 450.0};

Lamp made(const LampDesc& desc) {
    std::vector<std::string> warnings;
    Lamp lamp = make_lamp(desc, Affine::translation({5, 6, 7}), k_bands_nm, warnings);
    EXPECT_TRUE(warnings.empty());
    return lamp;
}

TEST(Sunlight, IsParallelAndBeginsAtTheSurface) {
    const Lamp lamp = made(slanting_sun());
    EXPECT_EQ(lamp.profile_name(), "sun");
    const Vector3 direction = slanting_sun().direction;
    std::mt19937 rng(2);
    for (int n = 0; n < 100; ++n) {
        const Point3 x = Point3{1, 2, 3} + 8.0 * random_direction(rng);
        const Point3 origin = lamp.origin(x);
        EXPECT_NEAR(origin.y, -3, 1e-12);
        const Vector3 way = x - origin;
        EXPECT_NEAR(glm::length(glm::cross(way, direction)), 0, 1e-12);
        EXPECT_EQ(lamp.relative_intensity(way), x.y > -3 ? 1 : 0);
        EXPECT_EQ(lamp.spread(glm::length(way)), 1);
        // As far down as the cosine of its slant says.
        EXPECT_NEAR(glm::length(way), std::abs(x.y + 3) / direction.y, 1e-12);
    }
}

TEST(Sunlight, LightsTheStretchOfARayBelowTheSurface) {
    const Lamp lamp = made(slanting_sun());
    std::mt19937 rng(3);
    for (int n = 0; n < 200; ++n) {
        const Ray ray{Point3{0, -3, 0} + 2.0 * random_direction(rng), random_direction(rng)};
        const Interval lit = lamp.beam(ray, {0.5, 6});
        for (double s = 0.505; s < 6; s += 0.01) {
            const Point3 x = ray.at(s);
            if (std::abs(x.y + 3) < 1e-9) continue;
            EXPECT_EQ(s > lit.begin && s<lit.end, x.y> - 3) << n << " " << s;
        }
    }
    const Ray level{{0, 1, 0}, {0, 0, 1}}, above{{0, -4, 0}, {0, 0, 1}};
    EXPECT_EQ(lamp.beam(level, {0, 5}).length(), 5);
    EXPECT_EQ(lamp.beam(above, {0, 5}).length(), 0);
}

// Beyond its reach the whole way is longer than the shortest by at least as much.
TEST(Sunlight, PassageHasItsReachAndNoOctaves) {
    const Lamp lamp = made(slanting_sun());
    std::mt19937 rng(4);
    for (int n = 0; n < 100; ++n) {
        const LampPassage passage = lamp.passage({{0.3, 0.4, 0.1}, random_direction(rng)});
        std::vector<double> breaks;
        append_octaves(passage, {0, 10}, breaks);
        EXPECT_TRUE(breaks.empty());
        double shortest = 1e9;
        for (double s = 0; s < 100; s += 0.1)
            if (passage.radius(s) >= 0) shortest = std::min(shortest, s + passage.radius(s));
        for (double s = passage.max_distance(2) + 1e-9; s < 100; s += 0.1)
            if (passage.radius(s) >= 0) {
                EXPECT_GE(s + passage.radius(s), shortest + 2 - 1e-9);
            }
    }
}

TEST(Sunlight, ADiscIsAsBrightAsItsIrradianceOnAPlaneThatFacesIt) {
    constexpr double k_angle = 40;
    const LampDesc desc = slanting_sun(k_angle, 200);
    std::vector<Lamp> emitters;
    append_emitters(desc, made(desc), 3, 1, {}, emitters);
    ASSERT_EQ(emitters.size(), 200U);
    double irradiance = 0, fraction = 0;
    Vector3 across{};
    const double edge = std::cos(glm::radians(0.5 * k_angle));
    for (const Lamp& emitter : emitters) {
        const Vector3& direction = emitter.sunlight()->direction;
        EXPECT_NEAR(glm::length(direction), 1, 1e-12);
        const double cosine = glm::dot(direction, desc.direction);
        EXPECT_GT(cosine, edge - 1e-3);  // the set is moved a little, to its middle
        irradiance += emitter.axis_intensity()[2] * cosine;
        fraction += emitter.fraction();
        across += emitter.axis_intensity()[2] * direction;
        EXPECT_EQ(emitter.index(), 3U);
    }
    EXPECT_NEAR(irradiance, 3, 1e-12);
    EXPECT_NEAR(fraction, 1, 1e-12);
    // The vector irradiance of a disc points along its axis; a lattice of N directions is even to
    // about 1/N^2.
    EXPECT_NEAR(glm::length(glm::cross(across, desc.direction)), 0, 3 * 1e-4);
    // Uniform radiance: E = L pi sin^2(angle / 2), so that the mean of the squared sine is half of
    // the largest. 1/N of it is the lattice's error.
    double squares = 0;
    for (const Lamp& emitter : emitters) {
        const double cosine = glm::dot(emitter.sunlight()->direction, desc.direction);
        squares += (1 - cosine * cosine) / 200;
    }
    EXPECT_NEAR(squares, 0.5 * (1 - edge * edge), 0.005 * (1 - edge * edge));
    append_emitters(desc, made(desc), 3, 4, {}, emitters);
    EXPECT_EQ(emitters.size(), 250U);
    // Without an angle it is one direction.
    append_emitters(slanting_sun(), made(slanting_sun()), 0, 1, {}, emitters);
    EXPECT_EQ(emitters.size(), 251U);
    EXPECT_EQ(emitters.back().sunlight()->direction, desc.direction);
}

TEST(Sunlight, LuxBecomeWattsThroughTheSpectrum) {
    LampDesc desc = slanting_sun();
    desc.intensity.reset();
    desc.lumens = 1000;
    desc.spectrum = LampSpectrumDesc{};
    const Lamp lamp = made(desc);
    // As the lumens of a lamp become watts in all.
    LampDesc other;
    other.lumens = 1000;
    other.spectrum = LampSpectrumDesc{};
    const Lamp bulb = made(other);
    for (std::size_t b = 0; b < 3; ++b)
        EXPECT_NEAR(lamp.axis_intensity()[b], 4 * std::numbers::pi * bulb.axis_intensity()[b],
                    1e-12 * lamp.axis_intensity()[b]);
}

}  // namespace
}  // namespace uw::test
