// ctest labels: unit analytic
// The parts of luminous surfaces that points stand for: areas by counting, positions by closed
// forms, and what mirrors them.
#include "core/light/lamp_patch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iostream>
#include <numbers>
#include <vector>

#include "core/light/lamp_factory.h"
#include "core/light/surface_lighting.h"
#include "tests/support/paths/closed_form_surfaces.h"

namespace uw::test {
namespace {

using std::numbers::pi;

LampDesc lamp_of(const LampExtentDesc& extent) {
    LampDesc lamp;
    lamp.profile = CosineProfileDesc{120};
    lamp.intensity = PerBand{1.0};
    lamp.extent = extent;
    return lamp;
}

std::vector<Lamp> points_of(const LampDesc& desc) {
    std::vector<std::string> warnings;
    const std::vector<double> bands{540};
    std::vector<Lamp> points;
    append_emitters(desc, make_lamp(desc, {}, bands, warnings), 0, 1, {}, points);
    return points;
}

LampExtentDesc panel_of(double width, double height, int samples) {
    return {LampExtentDesc::Shape::rectangle, width, height, 0, 0, samples};
}

LampExtentDesc disk_of(double radius, int samples) {
    return {LampExtentDesc::Shape::disk, 0, 0, 0, radius, samples};
}

constexpr int k_steps = 24;  // of places in a patch, in each direction

std::vector<Point3> fine_points(const Lamp& point) {
    std::vector<Point3> all;
    for (int i = 0; i < k_steps; ++i)
        for (int j = 0; j < k_steps; ++j)
            all.push_back(point.origin_on_patch({}, {(i + 0.5) / k_steps, (j + 0.5) / k_steps}));
    return all;
}

// All patches together are as dense everywhere: each of 8 x 8 equal parts of the surface has as
// many of their points, and no point is another's neighbour by chance of one patch.
TEST(LampPatches, CoverTheSurfaceEvenlyAroundTheirPoints) {
    for (const int samples : {2, 7, 32, 200}) {
        for (const LampExtentDesc& extent :
             {panel_of(0.8, 0.3, samples), panel_of(0.2, 0.9, samples)}) {
            std::vector<int> counts(64);
            double farthest = 0;
            for (const Lamp& point : points_of(lamp_of(extent))) {
                ASSERT_TRUE(point.is_part());
                Vector3 middle(0);
                for (const Point3& at : fine_points(point)) {
                    const double u = at.x / extent.width + 0.5, v = at.y / extent.height + 0.5;
                    ASSERT_TRUE(u > 0 && u < 1 && v > 0 && v < 1);
                    ++counts[static_cast<std::size_t>(8 * static_cast<int>(8 * u) +
                                                      static_cast<int>(8 * v))];
                    middle += from_origin(at) / static_cast<double>(k_steps * k_steps);
                }
                farthest = std::max(farthest, glm::length(middle - from_origin(point.position())));
            }
            const double even = samples * k_steps * k_steps / 64.0;
            for (const int count : counts) EXPECT_NEAR(count, even, 0.13 * even) << samples;
            // Points lie about sqrt(A/N) apart.
            EXPECT_LT(farthest, std::sqrt(extent.width * extent.height / samples)) << samples;
        }
    }
}

// A disk's rings of the same area have as many points, and its quarters, too.
TEST(LampPatches, OfADiskAreAsLarge) {
    constexpr int k_samples = 32;
    std::vector<int> rings(8), quarters(4);
    for (const Lamp& point : points_of(lamp_of(disk_of(0.5, k_samples))))
        for (const Point3& at : fine_points(point)) {
            const double fraction = (at.x * at.x + at.y * at.y) / 0.25;
            ASSERT_LT(fraction, 1);
            ++rings[static_cast<std::size_t>(8 * fraction)];
            ++quarters[static_cast<std::size_t>((at.x < 0 ? 2 : 0) + (at.y < 0 ? 1 : 0))];
        }
    const int all = k_samples * k_steps * k_steps;
    for (const int count : rings) EXPECT_NEAR(count, all / 8.0, 0.02 * all);
    for (const int count : quarters) EXPECT_NEAR(count, all / 4.0, 0.02 * all);
}

// Seen from anywhere, a sphere's patches together are as dense in each ring of a disk; each has its
// point in it or near.
TEST(LampPatches, OfASphereFillADiskFromEverywhere) {
    constexpr int k_samples = 64;
    constexpr double k_radius = 0.5;
    const LampExtentDesc extent{LampExtentDesc::Shape::sphere, 0, 0, 0, k_radius, k_samples};
    for (const Vector3& axis : {Vector3(0, 0, 1), Vector3(0, 1, 0), Vector3(0.6, 0, 0.8)}) {
        std::vector<int> rings(8);
        double farthest = 0;
        for (const Lamp& point : points_of(lamp_of(extent))) {
            Vector3 middle(0);
            for (int i = 0; i < k_steps; ++i)
                for (int j = 0; j < k_steps; ++j)
                    for (int k = 0; k < k_steps; ++k) {
                        const Vector3 at = from_origin(point.origin_on_patch(
                            {}, {(i + 0.5) / k_steps, (j + 0.5) / k_steps, (k + 0.5) / k_steps}));
                        const double far = glm::length(glm::cross(at, axis)) / k_radius;
                        ASSERT_LT(far, 1);
                        ++rings[static_cast<std::size_t>(8 * far * far)];
                        middle += at / static_cast<double>(k_steps * k_steps * k_steps);
                    }
            farthest = std::max(farthest, glm::length(middle - from_origin(point.position())));
        }
        const double all = std::pow(k_steps, 3) * k_samples;
        // Cubes of places that a ring's edge cuts: 24 x 4 of them along a line across the sphere.
        for (const int count : rings) EXPECT_NEAR(count, all / 8, 0.005 * all) << axis.x;
        // The sphere divided by 64 is a cube of 0.2 m.
        EXPECT_LT(farthest, 0.3);
    }
}

// The shadow rays of a sun with a disc come from all of it: their sines to its middle are spread
// evenly over a disk, so that their mean square is half of the largest.
TEST(LampPatches, OfASunFillItsDisc) {
    LampDesc desc;
    desc.direction = glm::normalize(Vector3(0.3, -0.1, 1));
    desc.profile = IsotropicProfileDesc{};
    desc.intensity = PerBand{1.0};
    desc.sun = SunDesc{30, 16, {{0, 0, 0}, {0, 0, -1}}};
    const Point3 x{0.4, 0.2, 5};
    double squares = 0;
    const std::vector<Lamp> points = points_of(desc);
    for (const Lamp& point : points)
        for (int i = 0; i < k_steps; ++i)
            for (int j = 0; j < k_steps; ++j) {
                const Point3 from =
                    point.origin_on_patch(x, {(i + 0.5) / k_steps, (j + 0.5) / k_steps});
                EXPECT_NEAR(from.z, 0, 1e-12);
                const Vector3 across = glm::cross(glm::normalize(x - from), desc.direction);
                squares += glm::dot(across, across) / (16.0 * k_steps * k_steps);
            }
    const double most = std::pow(std::sin(glm::radians(15.0)), 2);
    EXPECT_NEAR(squares, 0.5 * most, 1e-3 * most);
}

// What a smooth metal floor mirrors of a panel above it is a panel, not its points: along a line of
// the floor, the radiance is that of many points. Without the blur it would be a row of dots.
TEST(LampPatches, AreMirroredAsOneSurface) {
    const auto radiance = [](const std::vector<Lamp>& points, const Surfaces& metal, double x) {
        SurfaceSample sample;
        sample.hit.has_material = true;
        sample.hit.position = {x, 0.02, 1};
        sample.hit.normal = sample.hit.geometric_normal = {0, 0, -1};
        sample.ray = {{x, 0.02 - 1, 0}, glm::normalize(Vector3(0, 1, 1))};
        const SurfaceReflection reflection(metal, sample, 1);
        double sum = 0;
        for (const Lamp& point : points) {
            const Vector3 to_lamp = point.position() - sample.hit.position;
            const double r2 = glm::dot(to_lamp, to_lamp);
            Spectrum brdf;
            brdf_for(point, reflection, sample, brdf);
            sum += brdf[0] * point.axis_intensity()[0] * point.relative_intensity(-to_lamp) *
                   -to_lamp.z / (r2 * std::sqrt(r2));
        }
        return sum;
    };
    for (const double roughness : {0.05, 0.2, 0.4}) {
        LampDesc desc = lamp_of(panel_of(0.8, 0.6, 32));
        desc.position = {0, 1, 0};
        ClosedFormSurfaces metal;
        metal.add_sphere({0, 0, 9}, 1,
                         {{}, {.is_glossy = true, .roughness = roughness, .f0 = {{1}}}});
        const std::vector<Lamp> few = points_of(desc);
        desc.extent->samples = 1024;
        const std::vector<Lamp> many = points_of(desc);
        double worst = 0;
        for (double x = -0.3; x < 0.3; x += 0.005) {
            const double truth = radiance(many, metal, x);
            worst = std::max(worst, std::abs(radiance(few, metal, x) / truth - 1));
        }
        std::cout << "roughness " << roughness << ": worst " << 100 * worst << " %\n";
        // The smoother the metal, the more of the points is left: 23, 11 and 3.5 %.
        EXPECT_LT(worst, roughness < 0.1 ? 0.25 : 0.15) << roughness;
    }
}

/// The mean over a disk across z, evenly, or a sphere, as dense as 1 / sqrt(R^2 - r^2).
double mean_over(LampExtentDesc::Shape shape, double radius,
                 const std::function<double(const Vector3&)>& value) {
    constexpr int k_fine = 32;
    double sum = 0, weights = 0;
    for (int i = 0; i < k_fine; ++i)
        for (int j = 0; j < k_fine; ++j) {
            const double u = (i + 0.5) / k_fine, angle = 2 * pi * (j + 0.5) / k_fine;
            if (shape == LampExtentDesc::Shape::disk) {
                const double r = radius * std::sqrt(u);
                sum += value({r * std::cos(angle), r * std::sin(angle), 0});
                weights += 1;
                continue;
            }
            const double z = 2 * u - 1, across = std::sqrt(1 - z * z);
            for (int k = 0; k < k_fine; ++k) {
                // r = R sin t: the density times r^2 dr is in proportion to sin^2 t dt.
                const double sine = std::sin(0.5 * pi * (k + 0.5) / k_fine), r = radius * sine;
                sum += sine * sine *
                       value(r * Vector3(across * std::cos(angle), across * std::sin(angle), z));
                weights += sine * sine;
            }
        }
    return sum / weights;
}

/// A wide lamp with the profile of a spot has one soft edge, that of all of its places together: by
/// its points alone each would draw an edge of its own. Against quadrature over disk and sphere.
TEST(LampPatches, ASpotsEdgeIsThatOfTheWholeLamp) {
    for (const double edge : {0.0, 3.0})
        for (const auto shape : {LampExtentDesc::Shape::disk, LampExtentDesc::Shape::sphere}) {
            LampDesc desc = lamp_of({shape, 0, 0, 0, 0.3, 16});
            desc.profile = SpotProfileDesc{.beam = 50, .edge = edge};
            desc.direction = {0, 0, 1};
            const std::vector<Lamp> points = points_of(desc);
            std::vector<std::string> warnings;
            const Lamp whole = make_lamp(desc, {}, std::vector<double>{540}, warnings);
            double before = 1;
            for (double x = 0; x < 2.0; x += 0.1) {
                const Point3 at{x, 0.1, 2};
                double seen = 0;
                for (const Lamp& point : points)
                    seen += point.fraction() * point.relative_intensity(at - point.position());
                const double expected = mean_over(shape, 0.3, [&](const Vector3& place) {
                    return whole.relative_intensity(from_origin(at) - place);
                });
                // An edge of the same mean and variance, but another shape: the sixteenth part of a
                // sphere is 0.1 across.
                EXPECT_NEAR(seen, expected, 0.012) << x << " " << edge;
                EXPECT_LT(seen, before + 0.01) << x;  // one edge, no lobes
                before = seen;
            }
        }
}

/// A part's flux at each distance is that of a spot; close to it, where cos is no longer nearly
/// linear over the edge, within 4 %.
TEST(LampPatches, ASoftSpotKeepsItsFlux) {
    LampPlacement placement;
    std::vector<std::string> warnings;
    for (const auto falloff :
         {SpotProfileDesc::Falloff::smooth, SpotProfileDesc::Falloff::gltf,
          SpotProfileDesc::Falloff::blender, SpotProfileDesc::Falloff::blender_3_4})
        for (const double beam : {10.0, 50.0, 90.0, 140.0})
            for (const double edge : {0.0, 5.0, beam}) {
                const SpotProfile spot({.beam = beam, .edge = edge, .falloff = falloff}, placement);
                const SoftSpotProfile soft(spot, {0.02, 0, 0.01}, Matrix3(0.01));
                for (const double distance : {0.05, 0.2, 1.0, 5.0, 50.0}) {
                    double flux = 0;
                    constexpr int k_angles = 400, k_azimuths = 24;
                    for (int i = 0; i < k_angles; ++i)
                        for (int j = 0; j < k_azimuths; ++j) {
                            const double angle = pi * (i + 0.5) / k_angles;
                            const double azimuth = 2 * pi * (j + 0.5) / k_azimuths;
                            const Vector3 v(std::sin(angle) * std::cos(azimuth),
                                            std::sin(angle) * std::sin(azimuth), std::cos(angle));
                            flux += 2 * pi * pi / k_angles / k_azimuths * std::sin(angle) *
                                    soft.relative_intensity(distance * v + Vector3(0.02, 0, 0.01));
                        }
                    EXPECT_NEAR(flux / spot.solid_angle(), 1, 0.04)
                        << beam << " " << edge << " " << distance << " "
                        << static_cast<int>(falloff);
                }
            }
}

}  // namespace
}  // namespace uw::test
