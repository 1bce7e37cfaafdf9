#pragma once

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "core/base/error.h"
#include "core/base/vector_math.h"

namespace uw {

/// A rotation as a unit quaternion w + xi + yj + zk; q and -q are the same rotation.
struct Rotation {
    double w = 1, x = 0, y = 0, z = 0;

    /// The rotation that applies `other` first: a_from_c = a_from_b * b_from_c.
    Rotation operator*(const Rotation& other) const;
    Rotation inverse() const { return {w, -x, -y, -z}; }
    Matrix3 matrix() const;

    friend bool operator==(const Rotation&, const Rotation&) = default;
};

/// The rotation of a rotation matrix (Shepperd 1978); for one with rounding errors, a rotation as
/// close to it.
Rotation rotation_of(const Matrix3& matrix);

/// The rotation of any quaternion but 0, normalised to length 1.
Rotation normalised(const Rotation& q);

/// The rotation about the axis of `v` by its length [rad].
Rotation rotation_by(const Vector3& v);

/// The shortest `v` for which rotation_by(v) is `rotation`: at most pi long.
Vector3 rotation_vector(const Rotation& rotation);

/// The pose of a body: the rigid map from its space to another.
struct Pose {
    Point3 position;
    Rotation rotation;

    Affine affine() const { return {rotation.matrix(), from_origin(position)}; }

    friend bool operator==(const Pose&, const Pose&) = default;
};

/// The pose of a rigid map.
inline Pose pose_of(const Affine& rigid) {
    return {at_origin_plus(rigid.offset()), rotation_of(rigid.linear())};
}

/// A body's pose in the world, and how it changes with time.
struct BodyMotion {
    Pose pose;
    Vector3 velocity{0.0};              // of its origin, world [m/s]
    Vector3 acceleration{0.0};          // of its origin, world [m/s^2]
    Vector3 angular_velocity{0.0};      // in the body's axes [rad/s]
    Vector3 angular_acceleration{0.0};  // in the body's axes [rad/s^2]
};

/// The motion of what is fixed to a body, `body_from_part` (rigid): with the lever arm r in the
/// body's axes, a + R (alpha x r + omega x (omega x r)).
BodyMotion motion_of_part(const BodyMotion& body, const Affine& body_from_part);

/// The pose of a body at a time [s].
struct TimedPose {
    double time = 0;
    Pose pose;

    friend bool operator==(const TimedPose&, const TimedPose&) = default;
};

/// A place between two of a spline's knots.
struct KnotSpan {
    std::size_t first = 0;  // the knot before; for the last place, the one before the last knot
    double width = 0;       // between the knots
    double fraction = 0;    // of the distance to the next knot, 0 to 1
};

/// The span of `knots` (strictly ascending, at least two) in which `at` lies; places outside are
/// taken to the nearest end.
inline KnotSpan span_of(const std::vector<double>& knots, double at) {
    const double inside = std::clamp(at, knots.front(), knots.back());
    const auto after = std::upper_bound(knots.begin() + 1, knots.end() - 1, inside);
    const auto first = static_cast<std::size_t>(after - knots.begin()) - 1;
    const double width = knots[first + 1] - knots[first];
    return {first, width, (inside - knots[first]) / width};
}

/// A smooth curve through points: the natural cubic spline over the knots, continuous up to its
/// second derivative (de Boor, A Practical Guide to Splines, 1978, chapter IV).
class PositionSpline {
  public:
    /// `knots`: strictly ascending, at least two, one per point.
    PositionSpline(const std::vector<double>& knots, const std::vector<Point3>& points);

    Point3 at(const std::vector<double>& knots, double u) const;
    /// The derivative of the position by the knots' parameter.
    Vector3 velocity(const std::vector<double>& knots, double u) const;
    /// The second derivative by the knots' parameter.
    Vector3 acceleration(const std::vector<double>& knots, double u) const;

  private:
    std::vector<Point3> points_;
    std::vector<Vector3> bends_;  // second derivatives at the knots
};

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
    /// The angular velocity and acceleration in the body's axes, by the knots' parameter; at a
    /// knot, where the acceleration has a step, that after it.
    struct Turning {
        Vector3 velocity{0.0}, acceleration{0.0};
    };
    Turning turning(const std::vector<double>& knots, double u) const;

  private:
    struct Arc;
    Arc arc_at(const std::vector<double>& knots, double u) const;

    std::vector<Rotation> rotations_;
    std::vector<Vector3> velocities_;  // angular, in the body's axes, per unit of the parameter
};

/// From `a` to `b`, the shorter way round, at a steady rate (Shoemake's slerp): `fraction` 0 to 1.
Rotation turned(const Rotation& a, const Rotation& b, double fraction);

/// How a body moves between the poses of its trajectory.
enum class Interpolation {
    smooth,  ///< PositionSpline and RotationSpline
    linear,  ///< straight from pose to pose, turning at a steady rate
};

/// The times of a trajectory's poses.
struct Pacing {
    enum class Kind {
        given,     ///< their own
        constant,  ///< from the first's to the last's, at a constant speed along the path
        speed,     ///< from the first's on, at `speed` along the path
    };
    Kind kind = Kind::given;
    double speed = 0;  ///< [m/s], > 0

    friend bool operator==(const Pacing&, const Pacing&) = default;
};

/// A body's poses over time, through given ones. Immutable, thread safe.
class Trajectory {
  public:
    /// The first pose, by its index, that a trajectory cannot have after the one before it: at a
    /// time that is not later; with a pace other than given, at the same position, so that no time
    /// would pass.
    static std::optional<std::size_t> first_fault(const std::vector<TimedPose>& poses,
                                                  const Pacing& pacing);

    /// Precondition: at least one pose, and no first_fault. With a pace other than given the path
    /// is parameterised centripetally (Lee 1989), whatever the times between the first and the
    /// last; with a speed only the first's counts.
    Trajectory(const std::vector<TimedPose>& poses, Interpolation interpolation,
               Pacing pacing = {});

    /// The pose at a time [s]; times outside are taken to the nearest end.
    Pose at(double time) const;
    /// The same, but outside it continues the motion at the nearest end: by point reflection there
    /// in time and space.
    Pose at_or_beyond(double time) const;
    /// The pose with its exact derivatives. Precondition: is_smooth().
    BodyMotion motion_at(double time) const;
    /// Whether velocities are continuous: not if it goes straight from pose to pose.
    bool is_smooth() const { return poses_.size() == 1 || positions_.has_value(); }

    /// The times of the poses that it goes through [s], ascending.
    const std::vector<double>& times() const { return times_; }
    double first_time() const { return times_.front(); }
    double last_time() const { return times_.back(); }

  private:
    void pace(Interpolation interpolation, const Pacing& pacing);
    Vector3 velocity(double u) const;
    double length_between(double u0, double u1) const;
    double place_at_length(double length) const;
    double place_at(double time) const;

    std::vector<double> times_;
    std::vector<double> knots_;    // of the path: the times if they are given
    std::vector<double> lengths_;  // of the path up to each pose [m]; empty if the times are given
    std::vector<Pose> poses_;
    std::optional<PositionSpline> positions_;  // of a smooth one with several poses
    std::optional<RotationSpline> rotations_;
};

/// The formats of files of poses (core/motion/files).
enum class PoseFormat {
    tum,         ///< timestamp tx ty tz qx qy qz qw
    euroc,       ///< CSV: nanoseconds, position, quaternion with w first
    colmap,      ///< images.txt
    nerfstudio,  ///< transforms.json
};

/// How something moves: its poses over time, world_from_body.
struct TrajectoryDesc {
    std::vector<TimedPose> keyframes;  ///< written in the scene; none: in the file
    std::filesystem::path file;
    PoseFormat format = PoseFormat::tum;
    /// The file's time that is the scene's time 0 [s]; if omitted, that of its first pose. Files
    /// without times count frames instead, the scene's own.
    std::optional<double> start;
    double scale = 1;        ///< of the file's positions: metres per unit, > 0
    Affine world_from_file;  ///< rigid; applies after the scale
    Interpolation interpolation = Interpolation::smooth;
    Pacing pacing;
    SourceLocation where;
    /// The poses of all this as a trajectory, made when the scene is loaded (load_trajectory).
    std::shared_ptr<const Trajectory> trajectory;

    /// Whether the descriptions are the same; files may have changed in between.
    friend bool operator==(const TrajectoryDesc& a, const TrajectoryDesc& b) {
        return a.keyframes == b.keyframes && a.file == b.file && a.format == b.format &&
               a.start == b.start && a.scale == b.scale && a.world_from_file == b.world_from_file &&
               a.interpolation == b.interpolation && a.pacing == b.pacing;
    }
};

}  // namespace uw
