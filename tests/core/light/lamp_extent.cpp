// ctest labels: unit analytic
// The points that lamps with an extent consist of, against closed forms for what fills the extent.
#include "core/light/lamp_factory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace uw::test {
namespace {

using std::numbers::pi;

constexpr int k_default_samples = LampExtentDesc{}.samples;

LampExtentDesc rectangle(double width, double height, int samples = k_default_samples) {
    return {LampExtentDesc::Shape::rectangle, width, height, 0, 0, samples};
}

LampExtentDesc disk(double radius, int samples = k_default_samples) {
    return {LampExtentDesc::Shape::disk, 0, 0, 0, radius, samples};
}

/// A diffuse lamp at the origin that shines along z with `power` W.
LampDesc diffuse_lamp(const LampExtentDesc& extent, double power = pi) {
    LampDesc lamp;
    lamp.name = "panel";
    lamp.profile = CosineProfileDesc{120};
    lamp.power = PerBand{power};
    lamp.extent = extent;
    return lamp;
}

std::vector<Lamp> emitters_of(const LampDesc& desc, const Affine& world_from_camera = {},
                              int thinning = 1) {
    std::vector<std::string> warnings;
    const std::vector<double> bands{540};
    std::vector<Lamp> emitters;
    append_emitters(desc, make_lamp(desc, world_from_camera, bands, warnings), 2, thinning,
                    world_from_camera, emitters);
    EXPECT_TRUE(warnings.empty());
    return emitters;
}

double irradiance(const std::vector<Lamp>& emitters, const Point3& x, const Vector3& normal) {
    double sum = 0;
    for (const Lamp& emitter : emitters) {
        const Vector3 way = x - emitter.position();
        const double r = glm::length(way);
        sum += emitter.axis_intensity()[0] * emitter.relative_intensity(way) *
               std::max(0.0, -glm::dot(way, normal)) / (r * r * r);
    }
    return sum;
}

TEST(LampExtent, WithoutOneALampIsItself) {
    LampDesc desc = diffuse_lamp({});
    desc.extent.reset();
    desc.position = {1, 2, 3};
    const std::vector<Lamp> emitters = emitters_of(desc);
    ASSERT_EQ(emitters.size(), 1U);
    EXPECT_EQ(emitters[0].position(), desc.position);
    EXPECT_EQ(emitters[0].index(), 2U);
    EXPECT_EQ(emitters[0].fraction(), 1);
    EXPECT_EQ(emitters[0].axis_intensity()[0], 1);
}

TEST(LampExtent, ItsPointsFillItWhereTheLampIs) {
    const Affine moved =
        Affine::translation({1, 2, 3}) * Affine::rotation_xyz_degrees({20, -70, 110});
    for (const int samples : {1, 2, 7, 32, 200}) {
        LampDesc desc = diffuse_lamp(rectangle(0.8, 0.3, samples), 5);
        desc.position = {0.1, -0.2, 0.3};
        desc.direction = glm::normalize(Vector3(0.2, -0.3, 1));
        desc.extent->rotate = 25;
        const std::vector<Lamp> emitters = emitters_of(desc, moved);
        ASSERT_EQ(emitters.size(), static_cast<std::size_t>(samples));
        // Angle 0 is x, projected; the turn goes on towards `up`, anticlockwise from behind.
        const Vector3 across = glm::normalize(Vector3(1, 0, 0) - desc.direction.x * desc.direction);
        const Vector3 up = glm::cross(-desc.direction, across);
        const double turn = 25 * pi / 180;
        const Vector3 along_width = std::cos(turn) * across + std::sin(turn) * up;
        const Vector3 along_height = std::cos(turn) * up - std::sin(turn) * across;
        Vector3 mean(0.0);
        double fraction = 0, intensity = 0, widest = 0, highest = 0;
        for (const Lamp& emitter : emitters) {
            const Vector3 offset = moved.inverse() * emitter.position() - desc.position;
            EXPECT_NEAR(glm::dot(offset, desc.direction), 0, 1e-12);
            widest = std::max(widest, std::abs(glm::dot(offset, along_width)));
            highest = std::max(highest, std::abs(glm::dot(offset, along_height)));
            mean += offset / static_cast<double>(samples);
            fraction += emitter.fraction();
            intensity += emitter.axis_intensity()[0];
            EXPECT_EQ(emitter.index(), 2U);
        }
        EXPECT_NEAR(glm::length(mean), 0, 1e-12);
        EXPECT_NEAR(fraction, 1, 1e-12);
        EXPECT_NEAR(intensity, 5 / pi, 1e-12);  // of a diffuse lamp of 5 W
        // Moving the mean to the centre may move a point out by less than the steps between them.
        EXPECT_LT(widest, 0.4 * (1 + 1.0 / samples));
        EXPECT_LT(highest, 0.15 * (1 + 1.0 / samples));
        if (samples >= 32) {
            EXPECT_GT(widest, 0.95 * 0.4);
            EXPECT_GT(highest, 0.9 * 0.15);
        }
    }
}

// The density of a sphere's points is that whose sums along lines are all the same: on any line of
// sight they lie as evenly as on a disk. And outside of it the flux of points that each shine in
// all directions is that of one at the centre: Newton's theorem, for light.
TEST(LampExtent, ASpheresPointsLieOnADiskFromEverywhere) {
    constexpr double k_radius = 0.5;
    constexpr int k_samples = 1024;
    LampDesc desc = diffuse_lamp({LampExtentDesc::Shape::sphere, 0, 0, 0, k_radius, k_samples});
    desc.profile = IsotropicProfileDesc{};
    const std::vector<Lamp> emitters = emitters_of(desc);
    ASSERT_EQ(emitters.size(), static_cast<std::size_t>(k_samples));
    for (const Vector3& from : {Vector3(0, 0, 1), Vector3(1, 0, 0), Vector3(2, -1, 0.5)}) {
        const Vector3 axis = glm::normalize(from);
        std::vector<int> rings(8);
        for (const Lamp& emitter : emitters) {
            const double far = glm::length(glm::cross(from_origin(emitter.position()), axis));
            ++rings.at(std::min(static_cast<std::size_t>(8 * far * far / (k_radius * k_radius)),
                                std::size_t{7}));
        }
        // As many points at random would scatter by 11, the worst ring by 25.
        for (const int count : rings) EXPECT_NEAR(count, k_samples / 8, 16) << from.x;
        for (const double distance : {1.5, 2.0, 4.0, 20.0}) {
            const double r = distance * k_radius;
            const double at_centre = emitters[0].axis_intensity()[0] * k_samples / (r * r);
            // Near the sphere the steps between its points begin to show.
            EXPECT_NEAR(irradiance(emitters, at_origin_plus(r * axis), -axis), at_centre,
                        (distance < 2 ? 3e-3 : 1e-3) * at_centre)
                << distance;
        }
    }
}

TEST(LampExtent, DraftsHaveFewerPoints) {
    EXPECT_EQ(emitters_of(diffuse_lamp(disk(1, 32)), {}, 4).size(), 8U);
    EXPECT_EQ(emitters_of(diffuse_lamp(disk(1, 3)), {}, 4).size(), 1U);
}

// A diffuse disk of radiance L seen within the half angle theta: E = pi L sin^2 theta.
TEST(LampExtent, LightsThePointBelowADiskAsItShould) {
    const double radius = 0.5, radiance = 1 / (pi * radius * radius);  // 1 W/sr on the axis
    for (const double distance : {0.25, 0.5, 1.0, 4.0}) {
        const double sine2 = radius * radius / (radius * radius + distance * distance);
        const double truth = pi * radiance * sine2;
        const double found =
            irradiance(emitters_of(diffuse_lamp(disk(radius))), {0, 0, distance}, {0, 0, -1});
        // Nearer than its radius the points are seen one by one.
        EXPECT_NEAR(found, truth, (distance < radius ? 5e-3 : 1e-3) * truth) << distance;
    }
}

// The irradiance by a diffuse polygon, by Lambert's formula: L/2 sum of the angles that its edges
// subtend, each times the cosine between the normal and the edge's plane.
double irradiance_of_polygon(const std::vector<Point3>& corners, double radiance, const Point3& x,
                             const Vector3& normal) {
    double sum = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vector3 a = glm::normalize(corners[i] - x);
        const Vector3 b = glm::normalize(corners[(i + 1) % corners.size()] - x);
        sum += std::acos(glm::dot(a, b)) * glm::dot(glm::normalize(glm::cross(a, b)), normal);
    }
    return std::abs(0.5 * radiance * sum);
}

TEST(LampExtent, LightsSurfacesBelowARectangleAsItShould) {
    const double width = 0.8, height = 0.3;
    const std::vector<Point3> corners{
        {-0.4, -0.15, 0}, {0.4, -0.15, 0}, {0.4, 0.15, 0}, {-0.4, 0.15, 0}};
    const std::vector<Lamp> emitters = emitters_of(diffuse_lamp(rectangle(width, height)));
    // At least as far as the longer half; all of the rectangle is above each surface.
    for (const Point3& x : {Point3{0, 0, 0.5}, {0.3, 0.1, 0.5}, {0.9, -0.6, 1}, {0, 0.2, 3}})
        for (const Vector3& n : {Vector3(0, 0, -1), Vector3(0.3, 0.1, -1)}) {
            const Vector3 normal = glm::normalize(n);
            const double truth = irradiance_of_polygon(corners, 1 / (width * height), x, normal);
            EXPECT_NEAR(irradiance(emitters, x, normal), truth, 4e-3 * truth)
                << x.x << " " << x.y << " " << x.z;
        }
}

// Every edge in front of a lamp hides the part of it on one side of a line.
TEST(LampExtent, PenumbrasAreStepsAsSmallAsTheyCanBe) {
    for (const int samples : {16, 32, 128}) {
        const std::vector<Lamp> round = emitters_of(diffuse_lamp(disk(1, samples)));
        double squares = 0, worst = 0;
        int count = 0;
        for (int turn = 0; turn < 180; ++turn) {
            const double angle = turn * pi / 180;
            for (double t = -0.98; t < 1; t += 0.04) {
                double seen = 0;
                for (const Lamp& emitter : round) {
                    const Point3& p = emitter.position();
                    if (p.x * std::cos(angle) + p.y * std::sin(angle) < t)
                        seen += emitter.fraction();
                }
                // The segment of a circle.
                const double truth = 1 - (std::acos(t) - t * std::sqrt(1 - t * t)) / pi;
                squares += (seen - truth) * (seen - truth);
                worst = std::max(worst, std::abs(seen - truth));
                ++count;
            }
        }
        const double rms = std::sqrt(squares / count);
        std::cout << samples << " points: RMS " << 100 * rms << " %, worst " << 100 * worst
                  << " % of the lamp's light\n";
        EXPECT_LT(rms, 0.95 / samples);  // as the header says; a step is 1 / samples
        EXPECT_LT(worst, 3.5 / samples);
    }
}

}  // namespace
}  // namespace uw::test
