// ctest labels: unit analytic
// The derivatives of trajectories, on which what inertial sensors read depends.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "core/scene/trajectory.h"

namespace uw {
namespace {

/// A restless body: positions and rotations with no symmetry, at uneven times.
std::vector<TimedPose> restless() {
    std::vector<TimedPose> poses;
    double time = -0.3;
    for (int i = 0; i < 12; ++i) {
        const double x = i;
        poses.push_back({time,
                         {{std::sin(1.3 * x), 0.4 * x, std::cos(0.7 * x + 1)},
                          rotation_by({std::sin(x), 0.6 * std::cos(1.9 * x), 0.3 * x})}});
        time += 0.5 + 0.3 * std::sin(2.2 * x);
    }
    return poses;
}

/// The derivative of `f` by central differences of the eighth order.
template <class F>
Vector3 slope(const F& f, double at) {
    constexpr double k_step = 2e-3;
    constexpr std::array k_weights{4.0 / 5, -1.0 / 5, 4.0 / 105, -1.0 / 280};
    Vector3 sum(0.0);
    for (int i = 1; i <= 4; ++i)
        sum +=
            k_weights[static_cast<std::size_t>(i - 1)] * (f(at + i * k_step) - f(at - i * k_step));
    return sum / k_step;
}

// Velocities of poses, and accelerations of velocities. Differences of poses, which are rounded at
// 1e-16, over 2e-3 are right to 1e-12; a span is at least 0.2 s long and smooth to the eighth
// order.
TEST(TrajectoryMotion, IsTheDerivativeOfPosesWhateverThePace) {
    constexpr double k_tolerance = 1e-8;
    for (const Pacing& pacing :
         {Pacing{}, Pacing{Pacing::Kind::constant}, Pacing{Pacing::Kind::speed, 0.8}}) {
        const Trajectory trajectory(restless(), Interpolation::smooth, pacing);
        ASSERT_TRUE(trajectory.is_smooth());
        const std::vector<double>& times = trajectory.times();
        // The arc length of a given pace is a quadrature, right to 1e-9 of it (k_parts); its
        // rounding is divided by the step.
        const double tolerance = pacing.kind == Pacing::Kind::given ? k_tolerance : 1e-6;
        for (std::size_t span = 0; span + 1 < times.size(); ++span)
            for (const double fraction : {0.2, 0.55, 0.8}) {
                const double time = times[span] + fraction * (times[span + 1] - times[span]);
                const BodyMotion motion = trajectory.motion_at(time);
                const auto position = [&](double t) {
                    return from_origin(trajectory.at(t).position);
                };
                const auto turn = [&](double t) {
                    return rotation_vector(motion.pose.rotation.inverse() *
                                           trajectory.at(t).rotation);
                };
                const auto velocity = [&](double t) { return trajectory.motion_at(t).velocity; };
                const auto rate = [&](double t) {
                    return trajectory.motion_at(t).angular_velocity;
                };
                EXPECT_EQ(motion.pose, trajectory.at(time));
                EXPECT_LT(glm::length(motion.velocity - slope(position, time)), tolerance);
                EXPECT_LT(glm::length(motion.angular_velocity - slope(turn, time)), tolerance);
                EXPECT_LT(glm::length(motion.acceleration - slope(velocity, time)), tolerance);
                EXPECT_LT(glm::length(motion.angular_acceleration - slope(rate, time)), tolerance);
            }
    }
}

// A constant speed has no acceleration along the path, and the speed that was asked for.
TEST(TrajectoryMotion, AtAConstantSpeedIsAcceleratedAcrossThePathAlone) {
    const Trajectory trajectory(restless(), Interpolation::smooth, {Pacing::Kind::speed, 0.8});
    for (double time = 0; time < trajectory.last_time(); time += 0.37) {
        const BodyMotion motion = trajectory.motion_at(time);
        EXPECT_NEAR(glm::length(motion.velocity), 0.8, 1e-9);
        EXPECT_NEAR(glm::dot(motion.velocity, motion.acceleration), 0, 1e-9);
    }
}

// What is fixed to a body moves as its own pose over time does.
TEST(TrajectoryMotion, OfAPartHasTheLeverArm) {
    const Trajectory trajectory(restless(), Interpolation::smooth);
    const Affine body_from_part(rotation_by({0.3, -1.1, 0.7}).matrix(), {0.4, -0.2, 0.9});
    const auto part_at = [&](double t) {
        return motion_of_part(trajectory.motion_at(t), body_from_part);
    };
    for (std::size_t span = 0; span + 1 < trajectory.times().size(); ++span) {
        const double time = 0.5 * (trajectory.times()[span] + trajectory.times()[span + 1]);
        const BodyMotion part = part_at(time);
        const Affine pose = trajectory.at(time).affine() * body_from_part;
        EXPECT_LT(distance(part.pose.position, at_origin_plus(pose.offset())), 1e-14);
        EXPECT_LT(
            glm::length(rotation_vector(part.pose.rotation.inverse() * rotation_of(pose.linear()))),
            1e-14);
        const auto position = [&](double t) { return from_origin(part_at(t).pose.position); };
        const auto velocity = [&](double t) { return part_at(t).velocity; };
        const auto turn = [&](double t) {
            return rotation_vector(part.pose.rotation.inverse() * part_at(t).pose.rotation);
        };
        const auto rate = [&](double t) { return part_at(t).angular_velocity; };
        EXPECT_LT(glm::length(part.velocity - slope(position, time)), 1e-8);
        EXPECT_LT(glm::length(part.acceleration - slope(velocity, time)), 1e-8);
        EXPECT_LT(glm::length(part.angular_velocity - slope(turn, time)), 1e-8);
        EXPECT_LT(glm::length(part.angular_acceleration - slope(rate, time)), 1e-8);
    }
}

// Velocities and accelerations have no steps at the poses, nor has the angular velocity; its
// derivative may.
TEST(TrajectoryMotion, IsContinuousAtThePoses) {
    const Trajectory trajectory(restless(), Interpolation::smooth);
    constexpr double k_step = 1e-9;  // times a jerk below 100
    for (std::size_t i = 1; i + 1 < trajectory.times().size(); ++i) {
        const BodyMotion before = trajectory.motion_at(trajectory.times()[i] - k_step);
        const BodyMotion after = trajectory.motion_at(trajectory.times()[i] + k_step);
        EXPECT_LT(glm::length(before.velocity - after.velocity), 1e-6);
        EXPECT_LT(glm::length(before.acceleration - after.acceleration), 1e-6);
        EXPECT_LT(glm::length(before.angular_velocity - after.angular_velocity), 1e-6);
    }
    EXPECT_FALSE(Trajectory(restless(), Interpolation::linear).is_smooth());
}

}  // namespace
}  // namespace uw
