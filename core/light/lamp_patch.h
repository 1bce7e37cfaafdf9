#pragma once

#include <vector>

#include "core/base/vector_math.h"
#include "core/scene/lamp_desc.h"

namespace uw {

/// A point of the unit square.
struct UnitPoint {
    double u = 0, v = 0;
};

/// A luminous surface in the world, or the disc of a sun: there the unit is the sine of the angle
/// to the disc's middle in place of the metre.
struct LampFrame {
    LampExtentDesc extent;
    Vector3 x, y;  // unit vectors in the surface: x along a rectangle's width

    /// Its area [m^2].
    double area() const;
    /// The point that belongs to a point of the unit square, as seen from the centre [m]. Parts of
    /// the square that have the same area become parts of the surface that have.
    Vector3 at(const UnitPoint& place) const;
};

/// The part of a luminous surface that one of the points which stand for it stands for. The patches
/// of all points are equally large and cover the surface. Shadow rays end at another point of the
/// patch for each sample, so that a half-shade has no steps.
struct LampPatch {
    LampFrame frame;
    Point3 centre;         // of the surface; not of a sun
    UnitPoint begin, end;  // its corners in the unit square
    double radius = 0;     // of the disk that has its area [m]

    /// The point that belongs to a point of the unit square, as seen from the surface's centre [m].
    Vector3 at(const UnitPoint& place) const;
};

/// Divides a surface into a patch around each of the points that belong to `places`, or close to
/// it: by halves, in each of which there is half of the points.
std::vector<LampPatch> divide(const LampFrame& frame, const Point3& centre,
                              const std::vector<UnitPoint>& places);

}  // namespace uw
