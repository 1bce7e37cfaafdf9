#include "core/motion/trajectory.h"

#include <algorithm>
#include <cmath>

#include "core/base/quadrature.h"
#include "core/motion/knots.h"

namespace uw {

namespace {

// The parts of a span over which its length is integrated by Gauss's rule with four nodes: of a
// span that turns by a right angle the error is then below 1e-9 of its length.
constexpr int k_parts = 8;

std::vector<Point3> positions_of(const std::vector<Pose>& poses) {
    std::vector<Point3> positions;
    positions.reserve(poses.size());
    for (const Pose& pose : poses) positions.push_back(pose.position);
    return positions;
}

std::vector<Rotation> rotations_of(const std::vector<Pose>& poses) {
    std::vector<Rotation> rotations;
    rotations.reserve(poses.size());
    for (const Pose& pose : poses) rotations.push_back(pose.rotation);
    return rotations;
}

}  // namespace

std::optional<std::size_t> Trajectory::first_fault(const std::vector<TimedPose>& poses,
                                                   const Pacing& pacing) {
    for (std::size_t i = 1; i < poses.size(); ++i) {
        const bool is_fine = pacing.kind == Pacing::Kind::given
                                 ? poses[i].time > poses[i - 1].time
                                 : distance(poses[i].pose.position, poses[i - 1].pose.position) > 0;
        if (!is_fine) return i;
    }
    if (pacing.kind == Pacing::Kind::constant && poses.size() > 1 &&
        !(poses.back().time > poses.front().time))
        return poses.size() - 1;
    return std::nullopt;
}

Trajectory::Trajectory(const std::vector<TimedPose>& poses, Interpolation interpolation,
                       Pacing pacing) {
    for (const TimedPose& timed : poses) {
        poses_.push_back(timed.pose);
        times_.push_back(timed.time);
    }
    knots_ = times_;
    if (pacing.kind != Pacing::Kind::given && poses_.size() > 1) pace(interpolation, pacing);
    if (interpolation == Interpolation::smooth && poses_.size() > 1) {
        if (!positions_) positions_.emplace(knots_, positions_of(poses_));
        rotations_.emplace(knots_, rotations_of(poses_));
    }
}

// Sets the knots, the lengths and the times.
void Trajectory::pace(Interpolation interpolation, const Pacing& pacing) {
    knots_.front() = 0;
    for (std::size_t i = 1; i < knots_.size(); ++i)
        knots_[i] = knots_[i - 1] + std::sqrt(distance(poses_[i - 1].position, poses_[i].position));
    if (interpolation == Interpolation::smooth) positions_.emplace(knots_, positions_of(poses_));
    lengths_.push_back(0);
    for (std::size_t i = 1; i < knots_.size(); ++i)
        lengths_.push_back(lengths_.back() + length_between(knots_[i - 1], knots_[i]));
    const double first = times_.front(), total = lengths_.back();
    const double duration =
        pacing.kind == Pacing::Kind::speed ? total / pacing.speed : times_.back() - first;
    for (std::size_t i = 1; i < times_.size(); ++i)
        times_[i] = first + duration * (lengths_[i] / total);
}

Vector3 Trajectory::velocity(double u) const {
    if (positions_) return positions_->velocity(knots_, u);
    const KnotSpan span = span_of(knots_, u);
    return (poses_[span.first + 1].position - poses_[span.first].position) / span.width;
}

// Both within one span, whose velocity is smooth; at its ends the velocity is that of the span.
double Trajectory::length_between(double u0, double u1) const {
    double length = 0;
    const double step = (u1 - u0) / k_parts;
    for (int part = 0; part < k_parts; ++part)
        for (const QuadratureNode& node : gauss_legendre(4))
            length +=
                node.weight * step * glm::length(velocity(u0 + (part + node.position) * step));
    return length;
}

// Where on the path its length from the beginning is `length`: by bisection and Newton's method.
double Trajectory::place_at_length(double length) const {
    const KnotSpan span = span_of(lengths_, length);
    const double begin = knots_[span.first];
    const double rest = length - lengths_[span.first];
    double low = begin, high = knots_[span.first + 1];
    double u = begin + span.share * (high - low);
    constexpr int k_most_steps = 60;  // of bisection alone
    for (int step = 0; step < k_most_steps; ++step) {
        const double excess = length_between(begin, u) - rest;
        if (std::abs(excess) <= 1e-13 * lengths_.back()) break;
        (excess > 0 ? high : low) = u;
        const double newton = u - excess / glm::length(velocity(u));
        u = newton > low && newton < high ? newton : 0.5 * (low + high);
    }
    return u;
}

Pose Trajectory::at(double time) const {
    if (poses_.size() == 1) return poses_.front();
    double u = time;
    if (!lengths_.empty()) {
        const KnotSpan span = span_of(times_, time);
        u = place_at_length(lengths_[span.first] +
                            span.share * (lengths_[span.first + 1] - lengths_[span.first]));
    }
    if (positions_) return {positions_->at(knots_, u), rotations_->at(knots_, u)};
    const KnotSpan span = span_of(knots_, u);
    const Pose& a = poses_[span.first];
    const Pose& b = poses_[span.first + 1];
    return {a.position + span.share * (b.position - a.position),
            turned(a.rotation, b.rotation, span.share)};
}

Pose Trajectory::at_or_beyond(double time) const {
    const double nearest = std::clamp(time, first_time(), last_time());
    if (time == nearest) return at(time);
    const Pose end = at(nearest), within = at(2 * nearest - time);
    if (within == end) return end;  // to the bit: it stands still
    return {end.position + (end.position - within.position),
            end.rotation * within.rotation.inverse() * end.rotation};
}

}  // namespace uw
