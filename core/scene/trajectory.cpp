#include "core/scene/trajectory.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/numerics.h"

namespace uw {

Rotation Rotation::operator*(const Rotation& o) const {
    return {w * o.w - x * o.x - y * o.y - z * o.z, w * o.x + x * o.w + y * o.z - z * o.y,
            w * o.y - x * o.z + y * o.w + z * o.x, w * o.z + x * o.y - y * o.x + z * o.w};
}

Matrix3 Rotation::matrix() const {
    // Columns.
    return Matrix3(1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w),  //
                   2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w),  //
                   2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y));
}

Rotation normalised(const Rotation& q) {
    const double length = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
    return {q.w / length, q.x / length, q.y / length, q.z / length};
}

Rotation rotation_of(const Matrix3& m) {
    // Four times the products of the components; divides by the component with the largest square,
    // which is not small.
    const double trace = m[0][0] + m[1][1] + m[2][2];
    const double yz = m[1][2] - m[2][1], zx = m[2][0] - m[0][2], xy = m[0][1] - m[1][0];
    const std::array<double, 4> squares{1 + trace, 1 + 2 * m[0][0] - trace, 1 + 2 * m[1][1] - trace,
                                        1 + 2 * m[2][2] - trace};
    std::size_t largest = 0;
    for (std::size_t k = 1; k < 4; ++k)
        if (squares[k] > squares[largest]) largest = k;
    const double s01 = m[0][1] + m[1][0], s02 = m[0][2] + m[2][0], s12 = m[1][2] + m[2][1];
    switch (largest) {
        case 0:
            return normalised({squares[0], yz, zx, xy});
        case 1:
            return normalised({yz, squares[1], s01, s02});
        case 2:
            return normalised({zx, s01, squares[2], s12});
        default:
            return normalised({xy, s02, s12, squares[3]});
    }
}

Rotation rotation_by(const Vector3& v) {
    const double angle = glm::length(v);
    // sin(angle/2)/angle; below the limit its series is exact to rounding.
    const double factor = angle < 1e-4 ? 0.5 - angle * angle / 48 : std::sin(angle / 2) / angle;
    return {std::cos(angle / 2), factor * v.x, factor * v.y, factor * v.z};
}

Vector3 rotation_vector(const Rotation& q) {
    const double sign = q.w < 0 ? -1 : 1;
    const Vector3 imaginary(sign * q.x, sign * q.y, sign * q.z);
    const double sine = glm::length(imaginary);
    if (sine == 0) return Vector3(0.0);
    return imaginary * (2 * std::atan2(sine, sign * q.w) / sine);
}

PositionSpline::PositionSpline(const std::vector<double>& knots, const std::vector<Point3>& points)
    : points_(points), bends_(points.size(), Vector3(0.0)) {
    // The tridiagonal system for the bends at inner knots, by elimination; those at the ends are 0.
    const std::size_t count = points.size();
    std::vector<double> above(count, 0.0);
    for (std::size_t i = 1; i + 1 < count; ++i) {
        const double before = knots[i] - knots[i - 1], after = knots[i + 1] - knots[i];
        const double pivot = 2 * (before + after) - before * above[i - 1];
        above[i] = after / pivot;
        const Vector3 turn =
            (points[i + 1] - points[i]) / after - (points[i] - points[i - 1]) / before;
        bends_[i] = (6.0 * turn - before * bends_[i - 1]) / pivot;
    }
    for (std::size_t i = count - 1; i-- > 1;) bends_[i] -= above[i] * bends_[i + 1];
}

Point3 PositionSpline::at(const std::vector<double>& knots, double u) const {
    const KnotSpan span = span_of(knots, u);
    const double b = span.fraction, a = 1 - b;
    const Vector3 bent =
        (a * a * a - a) * bends_[span.first] + (b * b * b - b) * bends_[span.first + 1];
    const Point3 straight =
        points_[span.first] + b * (points_[span.first + 1] - points_[span.first]);
    return straight + span.width * span.width / 6 * bent;
}

Vector3 PositionSpline::velocity(const std::vector<double>& knots, double u) const {
    const KnotSpan span = span_of(knots, u);
    const double b = span.fraction, a = 1 - b;
    const Vector3 bent =
        (3 * b * b - 1) * bends_[span.first + 1] - (3 * a * a - 1) * bends_[span.first];
    return (points_[span.first + 1] - points_[span.first]) / span.width + span.width / 6 * bent;
}

Vector3 PositionSpline::acceleration(const std::vector<double>& knots, double u) const {
    const KnotSpan span = span_of(knots, u);
    return (1 - span.fraction) * bends_[span.first] + span.fraction * bends_[span.first + 1];
}

BodyMotion motion_of_part(const BodyMotion& body, const Affine& body_from_part) {
    const Matrix3 world_from_body = body.pose.rotation.matrix();
    const Vector3& arm = body_from_part.offset();
    const Vector3 round = glm::cross(body.angular_velocity, arm);
    const Matrix3 part_from_body = glm::transpose(body_from_part.linear());
    BodyMotion part;
    part.pose = {body.pose.position + world_from_body * arm,
                 normalised(body.pose.rotation * rotation_of(body_from_part.linear()))};
    part.velocity = body.velocity + world_from_body * round;
    part.acceleration =
        body.acceleration + world_from_body * (glm::cross(body.angular_acceleration, arm) +
                                               glm::cross(body.angular_velocity, round));
    part.angular_velocity = part_from_body * body.angular_velocity;
    part.angular_acceleration = part_from_body * body.angular_acceleration;
    return part;
}

namespace {

/// The turn from `a` to `b` in the axes of either.
Vector3 turn_between(const Rotation& a, const Rotation& b) {
    return rotation_vector(a.inverse() * b);
}

}  // namespace

RotationSpline::RotationSpline(const std::vector<double>& knots,
                               const std::vector<Rotation>& rotations)
    : rotations_(rotations), velocities_(rotations.size(), Vector3(0.0)) {
    const std::size_t last = rotations.size() - 1;
    const auto rate = [&](std::size_t i) {
        return turn_between(rotations[i], rotations[i + 1]) / (knots[i + 1] - knots[i]);
    };
    for (std::size_t i = 1; i < last; ++i) {
        const double before = knots[i] - knots[i - 1], after = knots[i + 1] - knots[i];
        velocities_[i] = (after * rate(i - 1) + before * rate(i)) / (before + after);
    }
    if (last == 1) {
        velocities_.front() = velocities_.back() = rate(0);
    } else {
        velocities_.front() = 2.0 * rate(0) - velocities_[1];
        velocities_.back() = 2.0 * rate(last - 1) - velocities_[last - 1];
    }
}

// The place on the curve within one span: the rotation at its first knot, and the three turns after
// it, of which each is weighted by a cumulative Bernstein polynomial of degree 3.
struct RotationSpline::Arc {
    Rotation begin;
    std::array<Vector3, 3> turns;
    double t = 0, width = 0;  // the fraction of the span, and its width
};

RotationSpline::Arc RotationSpline::arc_at(const std::vector<double>& knots, double u) const {
    const KnotSpan span = span_of(knots, u);
    const Rotation& a = rotations_[span.first];
    const Rotation& b = rotations_[span.first + 1];
    const Vector3 first = velocities_[span.first] * (span.width / 3);
    const Vector3 third = velocities_[span.first + 1] * (span.width / 3);
    const Vector3 second = rotation_vector(rotation_by(first).inverse() * a.inverse() * b *
                                           rotation_by(third).inverse());
    return {a, {first, second, third}, span.fraction, span.width};
}

Rotation RotationSpline::at(const std::vector<double>& knots, double u) const {
    const auto [a, turns, t, width] = arc_at(knots, u);
    const double left = 1 - t;
    return normalised(a * rotation_by(turns[0] * (1 - left * left * left)) *
                      rotation_by(turns[1] * (t * t * (3 - 2 * t))) *
                      rotation_by(turns[2] * (t * t * t)));
}

RotationSpline::Turning RotationSpline::turning(const std::vector<double>& knots, double u) const {
    const auto [a, turns, t, width] = arc_at(knots, u);
    const double left = 1 - t;
    const std::array<double, 3> weights{1 - left * left * left, t * t * (3 - 2 * t), t * t * t};
    const std::array<double, 3> first{3 * left * left, 6 * t * left, 3 * t * t};
    const std::array<double, 3> second{-6 * left, 6 - 12 * t, 6 * t};
    Turning result;
    for (std::size_t i = 0; i < 3; ++i) {
        // The product R E(t) of rotations, with E about a fixed axis and E' = E [w]x, has the
        // angular velocity E^T omega + w in its own axes, whose derivative is
        // E^T alpha - w x E^T omega + w'.
        const Matrix3 back = glm::transpose(rotation_by(turns[i] * weights[i]).matrix());
        const Vector3 own = turns[i] * (first[i] / width);
        const Vector3 carried = back * result.velocity;
        result.acceleration = back * result.acceleration - glm::cross(own, carried) +
                              turns[i] * (second[i] / (width * width));
        result.velocity = carried + own;
    }
    return result;
}

Rotation turned(const Rotation& a, const Rotation& b, double fraction) {
    return normalised(a * rotation_by(fraction * turn_between(a, b)));
}

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

// Both lie within one span, whose velocity is smooth; at its ends the velocity is that of the span.
double Trajectory::length_between(double u0, double u1) const {
    double length = 0;
    const double step = (u1 - u0) / k_parts;
    for (int part = 0; part < k_parts; ++part)
        for (const QuadratureNode& node : gauss_legendre(4))
            length +=
                node.weight * step * glm::length(velocity(u0 + (part + node.position) * step));
    return length;
}

// Finds where the arc length from the beginning is `length`, by bisection and Newton's method.
double Trajectory::place_at_length(double length) const {
    const KnotSpan span = span_of(lengths_, length);
    const double begin = knots_[span.first];
    const double rest = length - lengths_[span.first];
    double low = begin, high = knots_[span.first + 1];
    double u = begin + span.fraction * (high - low);
    constexpr int k_max_steps = 60;  // of bisection alone
    for (int step = 0; step < k_max_steps; ++step) {
        const double excess = length_between(begin, u) - rest;
        if (std::abs(excess) <= 1e-13 * lengths_.back()) break;
        (excess > 0 ? high : low) = u;
        const double newton = u - excess / glm::length(velocity(u));
        u = newton > low && newton < high ? newton : 0.5 * (low + high);
    }
    return u;
}

// The parameter of the path at a time.
double Trajectory::place_at(double time) const {
    if (lengths_.empty()) return time;
    const KnotSpan span = span_of(times_, time);
    return place_at_length(lengths_[span.first] +
                           span.fraction * (lengths_[span.first + 1] - lengths_[span.first]));
}

Pose Trajectory::at(double time) const {
    if (poses_.size() == 1) return poses_.front();
    const double u = place_at(time);
    if (positions_) return {positions_->at(knots_, u), rotations_->at(knots_, u)};
    const KnotSpan span = span_of(knots_, u);
    const Pose& a = poses_[span.first];
    const Pose& b = poses_[span.first + 1];
    return {a.position + span.fraction * (b.position - a.position),
            turned(a.rotation, b.rotation, span.fraction)};
}

BodyMotion Trajectory::motion_at(double time) const {
    BodyMotion motion;
    motion.pose = at(time);
    if (poses_.size() == 1) return motion;
    const double u = place_at(time);
    const Vector3 by_u = positions_->velocity(knots_, u);
    const Vector3 by_u_u = positions_->acceleration(knots_, u);
    double rate = 1, rate_change = 0;  // du/dt and d2u/dt2
    if (!lengths_.empty()) {
        // The speed c is constant, so that du/dt = c / |r'| and d2u/dt2 = -c^2 (r'.r'') / |r'|^4.
        const double speed = lengths_.back() / (times_.back() - times_.front());
        const double square = glm::dot(by_u, by_u);
        rate = speed / std::sqrt(square);
        rate_change = -rate * rate * glm::dot(by_u, by_u_u) / square;
    }
    const RotationSpline::Turning turning = rotations_->turning(knots_, u);
    motion.velocity = rate * by_u;
    motion.acceleration = rate * rate * by_u_u + rate_change * by_u;
    motion.angular_velocity = rate * turning.velocity;
    motion.angular_acceleration =
        rate * rate * turning.acceleration + rate_change * turning.velocity;
    return motion;
}

Pose Trajectory::at_or_beyond(double time) const {
    const double nearest = std::clamp(time, first_time(), last_time());
    if (time == nearest) return at(time);
    const Pose end = at(nearest), within = at(2 * nearest - time);
    if (within == end) return end;  // bit-exact: it stands still
    return {end.position + (end.position - within.position),
            end.rotation * within.rotation.inverse() * end.rotation};
}

}  // namespace uw
