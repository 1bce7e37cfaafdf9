#include "core/motion/rotation_spline.h"

#include <algorithm>

#include "core/motion/knots.h"

namespace uw {

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

Rotation RotationSpline::at(const std::vector<double>& knots, double u) const {
    const KnotSpan span = span_of(knots, u);
    const Rotation& a = rotations_[span.first];
    const Rotation& b = rotations_[span.first + 1];
    const Vector3 first = velocities_[span.first] * (span.width / 3);
    const Vector3 third = velocities_[span.first + 1] * (span.width / 3);
    const Vector3 second = rotation_vector(rotation_by(first).inverse() * a.inverse() * b *
                                           rotation_by(third).inverse());
    // The cumulative Bernstein polynomials of degree 3.
    const double t = span.share, left = 1 - t;
    return normalised(a * rotation_by(first * (1 - left * left * left)) *
                      rotation_by(second * (t * t * (3 - 2 * t))) *
                      rotation_by(third * (t * t * t)));
}

Rotation turned(const Rotation& a, const Rotation& b, double share) {
    return normalised(a * rotation_by(share * turn_between(a, b)));
}

}  // namespace uw
