// ctest labels: unit analytic
#include "core/scene/trajectory.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace uw {
namespace {

using std::numbers::pi;

/// A body on a circle of radius 2 m about the y axis, which it goes round once in 8 s, turned about
/// that axis and looking along its way.
Pose on_circle(double time) {
    const double angle = 2 * pi * time / 8;
    return {{2 * std::cos(angle), 1, -2 * std::sin(angle)}, rotation_by({0, angle, 0})};
}

std::vector<TimedPose> circle(double last, double step) {
    std::vector<TimedPose> poses;
    for (int i = 0; i * step <= last + 1e-9; ++i) poses.push_back({i * step, on_circle(i * step)});
    return poses;
}

double angle_between(const Rotation& a, const Rotation& b) {
    return glm::length(rotation_vector(a.inverse() * b));
}

/// The largest distance from the circle between 6 and 10 s of 16, away from the ends.
double circle_error(double step) {
    const Trajectory trajectory(circle(16, step), Interpolation::smooth);
    double error = 0;
    for (double time = 6; time <= 10; time += 0.0137)
        error = std::max(error, distance(trajectory.at(time).position, on_circle(time).position));
    return error;
}

TEST(Trajectories, GoThroughTheirPoses) {
    const std::vector<TimedPose> poses{{-1, {{0, 1, 2}, rotation_by({0.1, 0.2, -1})}},
                                       {0.5, {{3, 1, 2}, rotation_by({1, 0, 0.4})}},
                                       {0.7, {{3, -1, 0}, rotation_by({-2, 0.2, 0})}},
                                       {4, {{0, 0, 7}, rotation_by({0, 0, 0.1})}}};
    for (const Interpolation kind : {Interpolation::smooth, Interpolation::linear}) {
        const Trajectory trajectory(poses, kind);
        for (const TimedPose& timed : poses) {
            const Pose at = trajectory.at(timed.time);
            EXPECT_LT(distance(at.position, timed.pose.position), 1e-14);
            EXPECT_LT(angle_between(at.rotation, timed.pose.rotation), 1e-14);
        }
        EXPECT_EQ(trajectory.first_time(), -1);
        EXPECT_EQ(trajectory.last_time(), 4);
        EXPECT_EQ(trajectory.at(-5).position, trajectory.at(-1).position);
        EXPECT_EQ(trajectory.at(5).position, trajectory.at(4).position);
    }
}

// A cubic spline is off by at most 5/384 h^4 times the fourth derivative (Hall and Meyer 1976),
// here R (2 pi/8)^4. That the ends are straight, as the circle's are not, has died away by 0.27 a
// knot, to less than 1e-6 of it.
TEST(Trajectories, GoOnBeyondTheirEndsAsTheyMoveThere) {
    // Steadily round a circle: the turn goes on, and the position on the circle's other side of the
    // tangent, mirrored.
    const Trajectory trajectory(circle(4, 0.25), Interpolation::smooth);
    for (const double beyond : {0.05, 0.2}) {
        EXPECT_LT(
            angle_between(trajectory.at_or_beyond(-beyond).rotation, on_circle(-beyond).rotation),
            1e-9);
        EXPECT_LT(angle_between(trajectory.at_or_beyond(4 + beyond).rotation,
                                on_circle(4 + beyond).rotation),
                  1e-9);
        const Point3 first = on_circle(0).position;
        const Vector3 before = trajectory.at_or_beyond(-beyond).position - first;
        const Vector3 after = trajectory.at(beyond).position - first;
        EXPECT_LT(glm::length(before + after), 1e-12);
    }
    EXPECT_EQ(trajectory.at_or_beyond(1.3), trajectory.at(1.3));
    // What has one pose stands still.
    const Trajectory one(std::vector<TimedPose>{{1, on_circle(1)}}, Interpolation::smooth);
    EXPECT_EQ(one.at_or_beyond(7), one.at(1));
}

TEST(Trajectories, FollowACircleToFourthOrder) {
    const double bound = 5.0 / 384 * 2 * std::pow(2 * pi / 8, 4);
    EXPECT_LT(circle_error(0.5), bound * std::pow(0.5, 4));
    EXPECT_LT(circle_error(0.25), bound * std::pow(0.25, 4));
    EXPECT_NEAR(circle_error(0.5) / circle_error(0.25), 16, 1);
}

TEST(Trajectories, SteadyTurnsStaySteadyWhateverTheTimes) {
    const Rotation tilt = rotation_by({0.3, -0.2, 1});
    const Vector3 rate(0.4, 0.7, -0.2);
    std::vector<TimedPose> poses;
    for (const double time : {0.0, 0.3, 2.0, 2.1, 4.5})
        poses.push_back({time, {{time, 0, 0}, tilt * rotation_by(time * rate)}});
    for (const Interpolation kind : {Interpolation::smooth, Interpolation::linear}) {
        const Trajectory trajectory(poses, kind);
        for (double time = 0; time < 4.5; time += 0.01)
            EXPECT_LT(angle_between(trajectory.at(time).rotation, tilt * rotation_by(time * rate)),
                      1e-13)
                << time;
    }
}

/// The jump at `time` of the derivative of `order` 0, 1 or 2 of what `value` gives, by one-sided
/// differences over `h`.
template <class Value>
double jump(const Value& value, double time, int order, double h) {
    const Vector3 before[] = {value(time - 3 * h), value(time - 2 * h), value(time - h),
                              value(time)};
    const Vector3 after[] = {value(time), value(time + h), value(time + 2 * h),
                             value(time + 3 * h)};
    if (order == 1) return glm::length((after[1] - after[0] - (before[3] - before[2])) / h);
    return glm::length(
        (after[2] - 2.0 * after[1] + after[0] - (before[3] - 2.0 * before[2] + before[1])) /
        (h * h));
}

TEST(Trajectories, AreSmoothAtTheirPoses) {
    const std::vector<TimedPose> poses{{0, {{0, 0, 0}, {}}},
                                       {1, {{1, 0, 0}, rotation_by({0, 1, 0})}},
                                       {1.5, {{1, 2, 0}, rotation_by({1, 1, 0})}},
                                       {4, {{0, 2, 1}, rotation_by({0, 0, 0.5})}}};
    const Trajectory trajectory(poses, Interpolation::smooth);
    const auto position = [&](double time) { return from_origin(trajectory.at(time).position); };
    const auto turn = [&](double time) {
        return rotation_vector(poses[1].pose.rotation.inverse() * trajectory.at(time).rotation);
    };
    // Differences over h of a smooth curve jump by its derivatives times h, some 10 and 100 here.
    for (const double time : {1.0, 1.5}) {
        EXPECT_LT(jump(position, time, 1, 1e-5), 1e-3);
        EXPECT_LT(jump(position, time, 2, 1e-4), 1e-1);
    }
    EXPECT_LT(jump(turn, 1.0, 1, 1e-5), 1e-3);
    const Trajectory straight(poses, Interpolation::linear);
    const auto corner = [&](double time) { return from_origin(straight.at(time).position); };
    EXPECT_GT(jump(corner, 1.0, 1, 1e-5), 1);
}

TEST(Trajectories, DoNotDependOnTheChoiceOfAxes) {
    std::vector<TimedPose> poses{{0, {{0, 0, 0}, {}}},
                                 {1, {{1, 0, 0}, rotation_by({0, 1, 0})}},
                                 {3, {{1, 2, 0}, rotation_by({1, 1, 0})}}};
    const Trajectory first(poses, Interpolation::smooth);
    const Pose world{{1, 2, 3}, rotation_by({0.3, 2, 0.1})};
    const Rotation body = rotation_by({-1, 0.2, 0.9});
    for (TimedPose& timed : poses)
        timed.pose = {world.affine() * timed.pose.position,
                      world.rotation * timed.pose.rotation * body};
    const Trajectory second(poses, Interpolation::smooth);
    for (double time = 0; time < 3; time += 0.1) {
        const Pose a = first.at(time), b = second.at(time);
        EXPECT_LT(distance(world.affine() * a.position, b.position), 1e-14);
        EXPECT_LT(angle_between(world.rotation * a.rotation * body, b.rotation), 1e-14);
    }
}

// Way points on an ellipse, unevenly far apart, with a twist.
std::vector<TimedPose> way_points() {
    std::vector<TimedPose> poses;
    for (const double angle : {0.0, 0.2, 1.0, 1.3, 2.9, 3.0, 4.4})
        poses.push_back({0, {{3 * std::cos(angle), std::sin(angle), 0.1 * angle}, {}}});
    poses.front().time = 10;
    poses.back().time = 30;
    return poses;
}

/// The length of the path between two times, by chords.
double length_of(const Trajectory& trajectory, double first, double last) {
    constexpr int k_chords = 20000;
    double length = 0;
    for (int i = 0; i < k_chords; ++i)
        length += distance(trajectory.at(first + (last - first) * i / k_chords).position,
                           trajectory.at(first + (last - first) * (i + 1) / k_chords).position);
    return length;
}

TEST(Trajectories, HaveAConstantSpeedAlongThePath) {
    for (const Interpolation kind : {Interpolation::smooth, Interpolation::linear}) {
        const Trajectory trajectory(way_points(), kind, {Pacing::Kind::constant});
        EXPECT_EQ(trajectory.first_time(), 10);
        EXPECT_NEAR(trajectory.last_time(), 30, 1e-12);
        const double whole = length_of(trajectory, 10, 30);
        // Chords of 20000 a path are short of it by 1e-9, and of its corners by 1e-4 at most.
        for (const auto& [from, to] : {std::pair{10.0, 12.0}, {14.5, 15.0}, {29.0, 30.0}})
            EXPECT_NEAR(length_of(trajectory, from, to) / whole, (to - from) / 20,
                        kind == Interpolation::smooth ? 1e-8 : 1e-5);
        for (std::size_t i = 0; i < way_points().size(); ++i)
            EXPECT_LT(distance(trajectory.at(trajectory.times()[i]).position,
                               way_points()[i].pose.position),
                      1e-9);
    }
}

TEST(Trajectories, HaveTheSpeedGiven) {
    const Trajectory trajectory(way_points(), Interpolation::smooth, {Pacing::Kind::speed, 0.5});
    EXPECT_EQ(trajectory.first_time(), 10);
    const double first = length_of(trajectory, 12, 13);
    EXPECT_NEAR(first, 0.5, 1e-8);
    EXPECT_NEAR(length_of(trajectory, 10, trajectory.last_time()),
                0.5 * (trajectory.last_time() - 10), 1e-6);
}

TEST(Trajectories, OfOnePoseStandStill) {
    for (const Pacing::Kind kind : {Pacing::Kind::given, Pacing::Kind::speed}) {
        const Trajectory trajectory({{3, on_circle(1)}}, Interpolation::smooth, {kind, 1});
        EXPECT_EQ(trajectory.at(3), on_circle(1));
        EXPECT_EQ(trajectory.last_time(), 3);
    }
}

TEST(Trajectories, NameTheFirstFault) {
    const std::vector<TimedPose> late{{0, {}}, {1, {{1, 0, 0}, {}}}, {1, {{2, 0, 0}, {}}}};
    EXPECT_EQ(Trajectory::first_fault(late, {}), 2U);
    EXPECT_EQ(Trajectory::first_fault(late, {Pacing::Kind::constant}), std::nullopt);
    const std::vector<TimedPose> still{{0, {}}, {1, {}}, {2, {{2, 0, 0}, {}}}};
    EXPECT_EQ(Trajectory::first_fault(still, {}), std::nullopt);
    EXPECT_EQ(Trajectory::first_fault(still, {Pacing::Kind::speed, 1}), 1U);
    const std::vector<TimedPose> backward{{2, {}}, {0, {{1, 0, 0}, {}}}, {1, {{2, 0, 0}, {}}}};
    EXPECT_EQ(Trajectory::first_fault(backward, {Pacing::Kind::constant}), 2U);
}

}  // namespace
}  // namespace uw
