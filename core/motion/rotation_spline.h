#pragma once

#include <vector>

#include "core/motion/rotation.h"

namespace uw {

/// A smooth course of rotations through given ones: cubic Hermite curves of unit quaternions (Kim,
/// Kim and Shin, A General Construction Scheme for Unit Quaternion Curves, SIGGRAPH 1995). The
/// angular velocity is continuous; at a knot it is that of the parabola through the knot and its
/// neighbours (Bessel's tangent), so that a steady turn stays steady whatever the knots. Neither
/// the choice of the world's axes nor that of the body's changes the motion.
class RotationSpline {
  public:
    /// `knots`: strictly ascending, at least two, one per rotation. Successive rotations are taken
    /// the shorter way round.
    RotationSpline(const std::vector<double>& knots, const std::vector<Rotation>& rotations);

    Rotation at(const std::vector<double>& knots, double u) const;

  private:
    std::vector<Rotation> rotations_;
    std::vector<Vector3> velocities_;  // angular, in the body's axes, per unit of the parameter
};

/// From `a` to `b`, the shorter way round, at a steady rate (Shoemake's slerp): `share` 0 to 1.
Rotation turned(const Rotation& a, const Rotation& b, double share);

}  // namespace uw
