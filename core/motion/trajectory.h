#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/motion/pose.h"
#include "core/motion/position_spline.h"
#include "core/motion/rotation_spline.h"

namespace uw {

/// How a body moves between the poses of its trajectory.
enum class Interpolation {
    smooth,  ///< PositionSpline and RotationSpline
    linear,  ///< straight from pose to pose, turning at a steady rate
};

/// What times a trajectory's poses have.
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
    /// The same, but outside it goes on as it moves at its nearest end: mirrored there in time and
    /// in space.
    Pose at_or_beyond(double time) const;

    /// The times of the poses that it goes through [s], ascending.
    const std::vector<double>& times() const { return times_; }
    double first_time() const { return times_.front(); }
    double last_time() const { return times_.back(); }

  private:
    void pace(Interpolation interpolation, const Pacing& pacing);
    Vector3 velocity(double u) const;
    double length_between(double u0, double u1) const;
    double place_at_length(double length) const;

    std::vector<double> times_;
    std::vector<double> knots_;    // of the path: the times if they are given
    std::vector<double> lengths_;  // of the path up to each pose [m]; empty if the times are given
    std::vector<Pose> poses_;
    std::optional<PositionSpline> positions_;  // of a smooth one with several poses
    std::optional<RotationSpline> rotations_;
};

}  // namespace uw
