// ctest labels: unit analytic
// Each class of emitter obeys the laws of all; and what is special about each.
#include "core/light/emitter.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "core/geometry/water_surface.h"
#include "core/geometry/waves.h"
#include "core/light/directional_emitter.h"
#include "core/light/focused_emitter.h"
#include "core/light/lamp.h"
#include "core/light/mirrored_emitter.h"
#include "core/light/point_emitter.h"
#include "core/light/sun_focus.h"
#include "core/scene/waves_desc.h"
#include "tests/support/emitter_laws.h"
#include "tests/support/fresnel_by_angles.h"

namespace uw::test {
namespace {

using std::numbers::pi;

constexpr double k_water_index = 1.34;
const WaterSurfaceDesc k_ceiling{{0.1, 5, 0.2}, {0, 1, 0}, k_water_index};
const Point3 k_place{0.3, -0.2, 0.5};
// About the place of lamps, in the water; and across the water's surface.
const Ball k_around{{0, 0, 0}}, k_at_surface{{0, 5, 0}};
// Where light arrives that the water's surface reflects, a part of it or all.
const Ball k_far_around{{9, -1, 0}, 5.5};
const Sunlight k_slanting = Sunlight::from_air(glm::normalize(Vector3(0.5, -1, 0.3)), k_ceiling);

/// The whole of a disk or sphere, as one patch around k_place; or a disc around a sun.
LampPatch whole_of(LampExtentDesc::Shape shape, double radius, const Vector3& x = {1, 0, 0},
                   const Vector3& y = {0, 1, 0}) {
    LampExtentDesc extent;
    extent.shape = shape;
    extent.radius = radius;
    return {{extent, x, y}, k_place, {0, 0, 0}, {1, 1, 1}, radius};
}

PointEmitter point(LampProfile profile = IsotropicProfile()) {
    return {k_place, std::move(profile)};
}

PointEmitter sphere(double radius) {
    return {k_place, IsotropicProfile(), whole_of(LampExtentDesc::Shape::sphere, radius)};
}

SpotProfile slanting_spot() {
    return {{50, 20}, {Affine(), {0.6, 0, 0.8}}};
}

PointEmitter soft_spot() {
    const LampPatch patch = whole_of(LampExtentDesc::Shape::disk, 0.1);
    return {k_place, softened(slanting_spot(), patch.middle(), patch.covariance()), patch};
}

/// A direction of a sun, with a disc in the air around it.
DirectionalEmitter disc(double radius) {
    const Vector3 in_air = glm::normalize(Vector3(0.5, -1, 0.3));
    const LampPlacement placement{{}, in_air};
    return DirectionalEmitter(k_slanting,
                              whole_of(LampExtentDesc::Shape::disk, radius, placement.across(),
                                       glm::cross(in_air, placement.across())));
}

MirroredEmitter image_of(const PointEmitter& original) {
    return {std::make_shared<PointEmitter>(original), WaterSurface(k_ceiling)};
}

std::shared_ptr<const SunFocus> caustics() {
    WavesDesc waves;
    waves.shape = std::vector<SineWaveDesc>{{.amplitude = 0.1, .wavelength = 2}};
    WaterSurfaceDesc desc = k_ceiling;
    desc.waves = std::make_shared<const WavesDesc>(waves);
    return std::make_shared<SunFocus>(
        WaterSurface(desc), glm::normalize(Vector3(0.5, -1, 0.3)), 0.01,
        SunFocus::Extent{.side = 8, .is_periodic = true, .depth = 8}, 64);
}

TEST(PointEmitter, ObeysTheLaws) {
    expect_emitter_laws(point(), k_around);
    expect_emitter_laws(point(SpotProfile({80}, {})), k_around);
    expect_emitter_laws(point(slanting_spot()), k_around);
    expect_emitter_laws(point(CosineProfile({60}, {})), k_around);
    expect_emitter_laws(point(TableProfile({{0, 60}, {1, 0}}, {})), k_around);
    expect_emitter_laws(point(LineProfile({160, 20, 10}, {})), k_around);
    expect_emitter_laws(sphere(0.1), k_around);
    expect_emitter_laws(soft_spot(), k_around);
}

TEST(DirectionalEmitter, ObeysTheLaws) {
    expect_emitter_laws(DirectionalEmitter(k_slanting), k_at_surface);
    expect_emitter_laws(DirectionalEmitter({{0, 1, 0}, {{0, -3, 0}, {0, -1, 0}}}), {{0, -3, 0}});
    expect_emitter_laws(disc(0.01), {{0, 2, 0}, 2});
}

TEST(FocusedEmitter, ObeysTheLaws) {
    expect_emitter_laws(FocusedEmitter(k_ceiling, caustics()), {{0, 3, 0}});
}

TEST(MirroredEmitter, ObeysTheLaws) {
    expect_emitter_laws(image_of(point()), k_far_around);
    expect_emitter_laws(image_of(point(SpotProfile({120, 20}, {Affine(), {0.6, 0.8, 0}}))),
                        k_far_around);
    expect_emitter_laws(image_of(sphere(0.1)), k_around);
    expect_emitter_laws(image_of(soft_spot()), k_around);
}

// The flux that leaves each is what its profile says: also that of a profile made soft, at 1 m.
TEST(PointEmitter, HasTheFluxOfItsProfile) {
    for (const PointEmitter& emitter :
         {point(), point(slanting_spot()), point(CosineProfile({60}, {})), soft_spot()}) {
        const double stated = std::visit([](const auto& profile) { return profile.solid_angle(); },
                                         emitter.profile());
        // A soft edge keeps its flux to a few per cent close by
        // (LampPatches.ASoftSpotKeepsItsFlux), and to 2e-3 at ten radii.
        EXPECT_NEAR(solid_angle_of(emitter, 800), stated, 2e-3 * stated) << emitter.profile_name();
    }
}

// The law of reflection at the water's surface, by the path of the light itself: the image is
// where it seems to come from, as bright as the original in the direction in which the light sets
// out times what the surface reflects.
TEST(MirroredEmitter, IsTheLightThatTheSurfaceReflects) {
    const PointEmitter original = point(CosineProfile({140}, {Affine(), {0.3, 0.8, 0.2}}));
    const MirroredEmitter image = image_of(original);
    std::mt19937 rng(5);
    int partly = 0;
    for (int n = 0; n < 1000; ++n) {
        const Point3 x = k_far_around.point(rng);
        const Point3 seen = image.origin(x);
        const Point3 met = x + (5 - x.y) / (seen.y - x.y) * (seen - x);
        const Vector3 up = met - k_place, down = x - met;
        EXPECT_NEAR(glm::length(up) + glm::length(down), distance(seen, x), 1e-12);
        const double incidence = std::acos(glm::normalize(up).y);
        EXPECT_NEAR(incidence, std::acos(-glm::normalize(down).y), 1e-7);
        EXPECT_NEAR(glm::dot(glm::cross(up, down), {0, 1, 0}), 0, 1e-12);
        const bool is_total = std::sin(incidence) * k_water_index >= 1;
        const double reflected =
            is_total ? 1 : 1 - fresnel_by_angles(incidence, k_water_index, 1).mean();
        partly += is_total ? 0 : 1;
        EXPECT_NEAR(image.relative_intensity(x - seen), reflected * original.relative_intensity(up),
                    1e-9);
    }
    EXPECT_GT(partly, 100);
    EXPECT_LT(partly, 900);
}

// Of the light of an isotropic lamp the surface reflects one half, less the escaping fraction:
// int (1 - R) over the directions within the critical angle, by angles and the midpoint rule.
TEST(MirroredEmitter, HasTheFluxThatTheSurfaceReflects) {
    const double critical = std::asin(1 / k_water_index);
    constexpr int k_steps = 20000;
    double escaping = 0;
    for (int i = 0; i < k_steps; ++i) {
        // Square root of the angle to the critical one, in which the transmittance is smooth.
        const double u = (i + 0.5) / k_steps, angle = critical * (1 - u * u);
        escaping += 2 * pi * std::sin(angle) * fresnel_by_angles(angle, k_water_index, 1).mean() *
                    2 * u * critical / k_steps;
    }
    EXPECT_NEAR(solid_angle_of(image_of(point()), 800), 2 * pi - escaping, 1e-3);
}

// A change of brightness, of the index and of what an emitter is are independent of each other.
TEST(Lamp, IsTheSameByAnyOrderOfItsChanges) {
    const WaterSurface surface(k_ceiling);
    const Lamp bulb("bulb", k_place, slanting_spot(), Spectrum{{1, 2}});
    EXPECT_EQ(bulb.brightened(3).mirrored(surface), bulb.mirrored(surface).brightened(3));
    EXPECT_EQ(bulb.with_index(4).mirrored(surface), bulb.mirrored(surface).with_index(4));
    EXPECT_EQ(bulb.brightened(2).brightened(0.25), bulb.brightened(0.5));
    const Lamp sun("sun", k_slanting, Spectrum{{1, 2}});
    const std::shared_ptr<const SunFocus> focus = caustics();
    EXPECT_EQ(sun.brightened(4).focused(focus), sun.focused(focus).brightened(4));
    EXPECT_EQ(sun.with_index(4).focused(focus), sun.focused(focus).with_index(4));
}

TEST(Emitter, EqualsOnlyWhatIsTheSame) {
    const auto same = [] {
        std::vector<std::unique_ptr<Emitter>> all;
        all.push_back(std::make_unique<PointEmitter>(point()));
        all.push_back(std::make_unique<PointEmitter>(point(slanting_spot())));
        all.push_back(std::make_unique<PointEmitter>(sphere(0.1)));
        all.push_back(std::make_unique<PointEmitter>(sphere(0.2)));
        all.push_back(std::make_unique<DirectionalEmitter>(k_slanting));
        all.push_back(std::make_unique<DirectionalEmitter>(disc(0.1)));
        all.push_back(std::make_unique<MirroredEmitter>(image_of(point())));
        all.push_back(std::make_unique<MirroredEmitter>(image_of(sphere(0.1))));
        return all;
    };
    const auto some = same(), others = same();
    for (std::size_t i = 0; i < some.size(); ++i)
        for (std::size_t k = 0; k < others.size(); ++k) EXPECT_EQ(*some[i] == *others[k], i == k);
    const std::shared_ptr<const SunFocus> focus = caustics();
    const FocusedEmitter focused(k_ceiling, focus);
    EXPECT_TRUE(focused == FocusedEmitter(k_ceiling, focus));
    EXPECT_FALSE(focused == FocusedEmitter(k_ceiling, caustics()));
    EXPECT_FALSE(focused == DirectionalEmitter({focus->direction(), k_ceiling}));
    EXPECT_FALSE(DirectionalEmitter({focus->direction(), k_ceiling}) == focused);
}

}  // namespace
}  // namespace uw::test
