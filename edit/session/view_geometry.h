#pragma once

#include <optional>
#include <vector>

#include "camera/camera.h"
#include "core/scene/scene_desc.h"

namespace uw {

/// The image of a point of the world.
struct ViewHandle {
    std::optional<ImagePoint> pixel;  // none where the camera cannot see, behind it for example
    bool inside = false;              // within the image
    ImagePoint rim;  // the pixel, or from the image's centre towards it, on the image's edge
};

/// Exactly through lens and port (Camera::project).
ViewHandle view_handle(const Camera& camera, const Point3& world);

/// A lamp in the world.
struct PlacedLamp {
    Point3 position;
    Vector3 direction;  // unit
};
PlacedLamp placed_lamp(const LampDesc& lamp, const CameraDesc& camera);

/// The distance of the handle on a lamp's axis from the lamp [m].
inline constexpr double k_axis_length = 1;
Point3 axis_point(const PlacedLamp& lamp);

/// The outline of a lamp's beam in the image [pixels], where it has half its axis intensity, up to
/// its axis' handle: convex, without what the camera cannot see; empty for a lamp without a beam.
std::vector<ImagePoint> beam_outline(const Camera& camera, const LampDesc& lamp,
                                     const PlacedLamp& placed);
/// Half the angle between the directions of half intensity [degrees]; none for a lamp without a
/// beam, or whose profile is measured.
std::optional<double> beam_half_angle(const LampProfileDesc& profile);

/// The quantity that stays constant while a lamp is dragged in the image.
enum class DragKeeps { distance, depth };  // from the camera's centre; along its axis

/// The point that is imaged at `pixel`, at the same distance from the camera as `from` in the sense
/// of `keeps`. Throws UsageError of one line if there is none in the water.
Point3 dragged_point(const Camera& camera, const ImagePoint& pixel, const Point3& from,
                     DragKeeps keeps);
/// The point on the ray of `from`, at another distance from the camera's centre [m]; if `from` is
/// not visible, the point lies on the straight line to it. Throws as dragged_point.
Point3 point_at_distance(const Camera& camera, const Point3& from, double distance);
/// The direction, unit, of a lamp whose axis' handle is imaged at `pixel`: of two, the one closer
/// to the present one; if the handle cannot reach it, the direction towards the pixel's ray.
Vector3 aimed_direction(const Camera& camera, const ImagePoint& pixel, const PlacedLamp& lamp);

/// The points at 1 m in the water from the port of the image's corners, clockwise from the top
/// left; without those that have no ray into the water.
std::vector<Point3> view_frustum(const Camera& camera);

}  // namespace uw
