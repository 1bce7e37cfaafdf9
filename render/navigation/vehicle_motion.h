#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/scene/scene_desc.h"
#include "core/scene/trajectory.h"

namespace uw {

/// The motion of a scene's vehicle, to which its sensors are fixed: of its rig or its camera.
class VehicleMotion {
  public:
    /// `whole`: as it was read, which must outlive this object. Throws InputError for a scene whose
    /// camera is that of a glTF file, if it has sensors of a vehicle.
    explicit VehicleMotion(const SceneDesc& whole);

    /// The times at which it has a pose [s]; none: it never moves.
    std::optional<TimeRange> times() const;

    /// Whether its velocity has no steps.
    bool is_smooth() const;

    /// The pose of what is fixed to it by `body_from_part`, with its derivatives. Throws InputError
    /// at `where`, for which the derivatives are needed, if its velocity has steps.
    BodyMotion motion_at(double time, const Affine& body_from_part,
                         const SourceLocation& where) const;
    /// Likewise without derivatives, whatever its velocity.
    Pose pose_at(double time, const Affine& body_from_part) const;

  private:
    const TrajectoryDesc* desc_ = nullptr;  // null: it never moves
    Affine at_rest_;                        // world_from_body, if it never moves
};

/// The body_from_camera of a camera of the scene, by its place in the rig.
Affine body_from_camera(const SceneDesc& whole, std::size_t camera);

/// A series of readings: the one of number n is at n / rate [s].
struct ReadingRange {
    std::int64_t first = 0, last = -1;  // both included

    bool empty() const { return last < first; }
};

/// The readings within the times `wanted` [s], and the one before and after these, as far as the
/// vehicle has a pose.
ReadingRange readings_around(const TimeRange& wanted, double rate, const VehicleMotion& vehicle);

/// The number of the first reading of all, with which random walks begin: the first for which the
/// vehicle has a pose; 0 if it never moves.
std::int64_t first_reading(double rate, const VehicleMotion& vehicle);

}  // namespace uw
