#include "render/navigation/vehicle_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.h"

namespace uw {

namespace {

// Times are rounded decimals, so that a reading may lie outside of them by this much of the time
// from one to the next.
constexpr double k_reading_tolerance = 1e-6;

void refuse_gltf_camera(const SceneDesc& whole) {
    if (whole.navigation.empty() || !whole.cameras.empty() || whole.camera.has_pose) return;
    for (const GeometryDesc& object : whole.geometry)
        if (object.import.camera)
            throw InputError(fmt::format(
                "{}: is fixed to the camera, whose pose is that of a glTF file, without velocity; "
                "give the camera a pose or a trajectory",
                whole.navigation.front().where));
}

}  // namespace

VehicleMotion::VehicleMotion(const SceneDesc& whole) {
    refuse_gltf_camera(whole);
    if (whole.rig_trajectory)
        desc_ = &*whole.rig_trajectory;
    else if (whole.camera.trajectory)
        desc_ = &*whole.camera.trajectory;
    else if (whole.cameras.empty())
        at_rest_ = whole.camera.world_from_camera;
}

std::optional<TimeRange> VehicleMotion::times() const {
    if (desc_ == nullptr) return std::nullopt;
    return TimeRange{desc_->trajectory->first_time(), desc_->trajectory->last_time()};
}

bool VehicleMotion::is_smooth() const {
    return desc_ == nullptr || desc_->trajectory->is_smooth();
}

BodyMotion VehicleMotion::motion_at(double time, const Affine& body_from_part,
                                    const SourceLocation& where) const {
    BodyMotion body;
    if (desc_ == nullptr) {
        body.pose = pose_of(at_rest_);
    } else {
        if (!is_smooth())
            throw InputError(fmt::format(
                "{}: needs velocities and accelerations, and {} goes straight from pose to pose, "
                "where they jump; write interpolation: smooth there",
                where, desc_->where));
        body = desc_->trajectory->motion_at(time);
    }
    return motion_of_part(body, body_from_part);
}

Pose VehicleMotion::pose_at(double time, const Affine& body_from_part) const {
    const Affine body = desc_ == nullptr ? at_rest_ : desc_->trajectory->at(time).affine();
    return pose_of(body * body_from_part);
}

Affine body_from_camera(const SceneDesc& whole, std::size_t camera) {
    // As they are read, cameras of a rig have poses in its axes, or in the world if it never moves.
    return whole.cameras.empty() ? Affine() : whole.cameras[camera].camera.world_from_camera;
}

ReadingRange readings_around(const TimeRange& wanted, double rate, const VehicleMotion& vehicle) {
    const auto before = [&](double time) { return std::floor(time * rate + k_reading_tolerance); };
    const auto after = [&](double time) { return std::ceil(time * rate - k_reading_tolerance); };
    double first = before(wanted.first), last = after(wanted.last);
    if (const auto times = vehicle.times()) {
        first = std::max(first, after(times->first));
        last = std::min(last, before(times->last));
    } else {
        first = std::max(first, 0.0);
    }
    return {static_cast<std::int64_t>(first), static_cast<std::int64_t>(last)};
}

std::int64_t first_reading(double rate, const VehicleMotion& vehicle) {
    const auto times = vehicle.times();
    if (!times) return 0;
    return static_cast<std::int64_t>(std::ceil(times->first * rate - k_reading_tolerance));
}

}  // namespace uw
