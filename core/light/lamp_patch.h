#pragma once

#include <vector>

#include "core/base/vector_math.h"
#include "core/scene/lamp_desc.h"

namespace uw {

/// A point of the unit cube; only a sphere depends on its third coordinate.
struct UnitPoint {
    double u = 0, v = 0, w = 0;

    friend bool operator==(const UnitPoint&, const UnitPoint&) = default;
};

/// A luminous surface in the world, or the disc of a sun: there the unit is the sine of the angle
/// to the disc's middle in place of the metre.
///
/// A sphere is represented by points that fill it and shine through each other, their density
/// proportional to 1 / sqrt(radius^2 - r^2). On every line through it there are equally many of
/// them, so that outside its radiance is that of an opaque sphere with a diffuse surface.
struct LampFrame {
    LampExtentDesc extent;
    Vector3 x, y;  // unit vectors in the surface: x along a rectangle's width

    /// The area that is seen against its normal, or of a sphere from anywhere [m^2].
    double area() const;
    /// The point that belongs to a point of the unit cube, as seen from the centre [m]. Parts of
    /// the cube that have the same volume become parts of the lamp that shine equally.
    Vector3 at(const UnitPoint& place) const;

    bool is_flat() const { return extent.shape != LampExtentDesc::Shape::sphere; }

    friend bool operator==(const LampFrame&, const LampFrame&) = default;
};

/// The part of a luminous surface that one of the points which stand for it stands for. The patches
/// of all points are equally large and cover the surface. Shadow rays end at another point of the
/// patch for each sample, so that a half-shade has no steps.
struct LampPatch {
    LampFrame frame;
    Point3 centre;         // of the surface; not of a sun
    UnitPoint begin, end;  // its corners in the unit cube
    double radius = 0;     // of the disk that has its area [m]

    /// The point that belongs to a point of the unit cube, as seen from the surface's centre [m].
    Vector3 at(const UnitPoint& place) const;
    /// The middle of its points, as seen from the surface's centre [m].
    Vector3 middle() const;
    /// The covariance of its points about that middle [m^2].
    Matrix3 covariance() const;

    friend bool operator==(const LampPatch&, const LampPatch&) = default;
};

/// Divides a surface into a patch around each of the points that belong to `places`, or close to
/// it: by halves, in each of which there is half of the points.
std::vector<LampPatch> divide(const LampFrame& frame, const Point3& centre,
                              const std::vector<UnitPoint>& places);

}  // namespace uw
