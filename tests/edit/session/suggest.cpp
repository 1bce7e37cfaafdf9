// ctest labels: unit analytic
#include "edit/session/suggest.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <vector>

#include "core/base/error.h"
#include "tests/support/message_of.h"
#include "tests/support/test_scene.h"

namespace uw::test {
namespace {

SceneDesc rig() {
    SceneDesc desc = pinhole_scene(30, 20);
    desc.lamps = {isotropic_lamp({-0.3, 0.1, 0}, 40), isotropic_lamp({0.3, 0.1, 0}, 40)};
    desc.lamps[1].name = "right";
    return desc;
}

SuggestRequest along_x(double from, double to) {
    SuggestRequest request;
    request.from = {from, 0.1, 0};
    request.to = {to, 0.1, 0};
    request.distance = 2;
    return request;
}

// One ray, in the middle: the light of an isotropic lamp in the plane of the camera falls most on
// the target where the lamp is nearest to its foot, wherever the bar leads.
TEST(Suggest, FindsTheLampsPlaceOfMostLight) {
    SceneDesc desc = rig();
    desc.lamps.pop_back();
    TargetProbe probe({.rays = 1});
    SuggestRequest request = along_x(-1.7, 2.3);
    request.objective = SuggestRequest::Objective::irradiance;
    const Suggestion line = suggest_position(probe, ImageScene{SceneDesc(desc)}, request);
    // Steps are halved until they are below 1 cm.
    EXPECT_NEAR(line.best.position.x, 0, 0.01);
    EXPECT_EQ(line.best.position.y, 0.1);
    EXPECT_EQ(line.lamp.position, line.best.position);
    EXPECT_FALSE(line.partner);
    request.in_box = true;
    request.from = {-1, 0.9, -0.2};
    request.to = {1.3, -0.6, 0.4};
    request.samples = 400;
    const Suggestion box = suggest_position(probe, ImageScene{SceneDesc(desc)}, request);
    EXPECT_NEAR(box.best.position.x, 0, 0.01);
    EXPECT_NEAR(box.best.position.y, 0, 0.01);
    EXPECT_EQ(box.best.position.z, 0.4) << "the nearest to the target";
    EXPECT_EQ(box.map.size(), box.counts[0] * box.counts[1] * box.counts[2]);
    EXPECT_GT(std::min({box.counts[0], box.counts[1], box.counts[2]}), 1U);
}

// Against a dense scan with a probe of its own.
TEST(Suggest, FindsTheBestContrastOfABar) {
    const SceneDesc desc = rig();
    const SuggestRequest request = along_x(-1.5, 0.5);
    TargetProbe probe;
    const Suggestion found = suggest_position(probe, ImageScene{SceneDesc(desc)}, request);
    const auto contrast_at = [&](double x) {
        SceneDesc moved = desc;
        moved.lamps[0].position.x = x;
        TargetProbe fresh;
        return fresh.curve(ImageScene{std::move(moved)}, std::vector{2.0}).front().contrast;
    };
    double best = 0;
    for (int i = 0; i <= 200; ++i) best = std::max(best, contrast_at(-1.5 + 0.01 * i));
    EXPECT_GE(found.best.value, best - 1e-6);
    EXPECT_EQ(found.best.value, contrast_at(found.best.position.x));
    EXPECT_EQ(found.before.value, contrast_at(-0.3));
    EXPECT_GT(found.best.value, found.before.value);
    EXPECT_LE(found.tried, request.samples);
    ASSERT_EQ(found.counts, (std::array<std::size_t, 3>{100, 1, 1}));
    for (std::size_t i = 0; i < found.map.size(); ++i) {
        EXPECT_NEAR(found.map[i].position.x, -1.5 + 2.0 * static_cast<double>(i) / 99, 1e-12);
        EXPECT_LE(found.map[i].value, found.best.value);
    }
    EXPECT_EQ(found.map[40].value, contrast_at(found.map[40].position.x));
}

TEST(Suggest, GivesTheSameAnswerWhateverTheProbeHasKept) {
    const ImageScene scene{rig()};
    const SuggestRequest request = along_x(-1.5, 0.5);
    TargetProbe used, fresh;
    used.curve(scene, target_distances());
    const Suggestion a = suggest_position(used, scene, request);
    const std::uint64_t rendered = used.rendered();
    const Suggestion again = suggest_position(used, scene, request);
    EXPECT_EQ(used.rendered(), rendered);
    const Suggestion b = suggest_position(fresh, scene, request);
    for (const Suggestion* other : {&again, &b}) {
        EXPECT_EQ(a.best.position, other->best.position);
        EXPECT_EQ(a.best.value, other->best.value);
        EXPECT_EQ(a.tried, other->tried);
        for (std::size_t i = 0; i < a.map.size(); ++i)
            EXPECT_EQ(a.map[i].value, other->map[i].value);
    }
}

TEST(Suggest, KeepsThePartnerOnTheOtherSide) {
    SceneDesc desc = rig();
    // The partner stands in the world, the camera is turned.
    desc.camera.world_from_camera =
        Affine::translation({1, 2, 3}) * Affine::rotation_xyz_degrees({10, 40, 5});
    desc.lamps[1].fixed_to_camera = false;
    desc.lamps[0].profile = SpotProfileDesc{.beam = 70, .edge = 10};
    SuggestRequest request = along_x(-1.5, -0.1);
    request.partner = 1;
    request.aim = SuggestRequest::Aim::target;
    TargetProbe probe;
    const Suggestion found = suggest_position(probe, ImageScene{SceneDesc(desc)}, request);
    const Affine camera_from_world = desc.camera.world_from_camera.inverse();
    const Point3 lamp = found.lamp.position;
    const Point3 partner = camera_from_world * found.partner->position;
    EXPECT_LT(distance(partner, {-lamp.x, lamp.y, lamp.z}), 1e-12);
    const Vector3 to_target = glm::normalize(Point3{0, 0, 2} - lamp);
    EXPECT_LT(glm::length(found.lamp.direction - to_target), 1e-12);
    const Vector3 mirrored = camera_from_world.apply_to_vector(found.partner->direction);
    EXPECT_LT(glm::length(mirrored - Vector3(-to_target.x, to_target.y, to_target.z)), 1e-12);
    // The numbers are those of the scene with both moved.
    desc.lamps = {found.lamp, *found.partner};
    TargetProbe fresh;
    EXPECT_NEAR(fresh.curve(ImageScene{SceneDesc(desc)}, std::vector{2.0}).front().contrast,
                found.best.value, 1e-9);
}

TEST(Suggest, LeavesOutPlacesOfTooLittleLight) {
    SceneDesc desc = rig();
    desc.lamps.pop_back();
    const ImageScene scene{std::move(desc)};
    SuggestRequest request = along_x(-3, 0);
    TargetProbe probe;
    const Suggestion free = suggest_position(probe, scene, request);
    request.min_light = 0.7;
    const Suggestion lit = suggest_position(probe, scene, request);
    EXPECT_LT(free.best.numbers.irradiance, 0.7 * free.before.numbers.irradiance);
    EXPECT_TRUE(lit.best.allowed);
    EXPECT_GE(lit.best.numbers.irradiance, 0.7 * lit.before.numbers.irradiance);
    for (const SuggestPoint& point : lit.map)
        EXPECT_TRUE(!point.allowed || point.value <= lit.best.value);
    EXPECT_FALSE(lit.map.front().allowed);
    request.min_light = 1000;
    EXPECT_FALSE(suggest_position(probe, scene, request).best.allowed);
}

TEST(Suggest, IsBoundedAndCanBeCancelled) {
    const ImageScene scene{rig()};
    SuggestRequest request = along_x(-1.5, 0.5);
    request.samples = 12;
    TargetProbe probe({.rays = 1});
    std::size_t told = 0;
    const Suggestion found = suggest_position(
        probe, scene, request, [&](const Suggestion& sofar) { EXPECT_EQ(sofar.tried, ++told); });
    EXPECT_LE(found.tried, 12U);
    EXPECT_EQ(found.tried, told);
    {
        std::atomic<bool> stop = false;
        const StopScope scope(stop);
        EXPECT_THROW(suggest_position(probe, scene, request,
                                      [&](const Suggestion& sofar) { stop = sofar.tried >= 5; }),
                     Interrupted);
    }
    const auto refused = [&](const std::function<void(SuggestRequest&)>& change) {
        SuggestRequest wrong = request;
        change(wrong);
        EXPECT_NE(message_of<UsageError>([&] { suggest_position(probe, scene, wrong); }), "");
    };
    refused([](SuggestRequest& r) { r.lamp = 2; });
    refused([](SuggestRequest& r) { r.partner = 0; });
    refused([](SuggestRequest& r) { r.to = r.from; });
    refused([](SuggestRequest& r) { r.distance = 0; });
    refused([](SuggestRequest& r) { r.samples = 11; });
    refused([](SuggestRequest& r) { r.min_light = -1; });
}

TEST(MirroredLamp, IsOnTheOtherSideOfTheCameraInItsOwnFrame) {
    LampDesc lamp = isotropic_lamp({-0.7, 0.1, 0.2}, 5);
    lamp.direction = glm::normalize(Vector3(0.3, -0.2, 1));
    const Affine camera =
        Affine::translation({1, 2, 3}) * Affine::rotation_xyz_degrees({10, 40, 5});
    const LampDesc fixed = mirrored_lamp(lamp, camera);
    EXPECT_EQ(fixed.position, (Point3{0.7, 0.1, 0.2})) << "to the bit";
    EXPECT_EQ(fixed.direction.x, -lamp.direction.x);
    LampDesc standing = lamp;
    standing.fixed_to_camera = false;
    standing.position = camera * lamp.position;
    standing.direction = camera.apply_to_vector(lamp.direction);
    const LampDesc other = mirrored_lamp(standing, camera);
    EXPECT_LT(distance(other.position, camera * fixed.position), 1e-12);
    EXPECT_LT(glm::length(other.direction - camera.apply_to_vector(fixed.direction)), 1e-12);
    EXPECT_LT(distance(mirrored_lamp(other, camera).position, standing.position), 1e-12);
}

}  // namespace
}  // namespace uw::test
