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

/// A luminous surface in the world, or the disc of a sun, where the unit is the sine of the angle
/// to the disc's centre rather than the metre.
///
/// A sphere is represented by points that fill it and do not occlude each other, with a density
/// proportional to 1 / sqrt(radius^2 - r^2). The integral of that density is the same on all
/// chords, so that from outside its radiance is that of an opaque sphere with a diffuse surface.
struct LampFrame {
    LampExtentDesc extent;
    Vector3 x, y;  // unit vectors in the surface: x along a rectangle's width

    /// Its area, or the cross section of a sphere [m^2].
    double area() const;
    /// Maps a point of the unit cube to a point of the lamp, relative to its centre [m]. Parts of
    /// the cube with the same volume map to parts of the lamp with the same power.
    Vector3 at(const UnitPoint& place) const;

    bool is_flat() const { return extent.shape != LampExtentDesc::Shape::sphere; }

    friend bool operator==(const LampFrame&, const LampFrame&) = default;
};

/// The part of a luminous surface that one of its emitters represents. The patches of all emitters
/// have the same area and cover the surface. Each sample's shadow ray ends at another point of the
/// patch, so that a penumbra has no steps.
struct LampPatch {
    LampFrame frame;
    Point3 centre;         // of the surface; unused for a sun
    UnitPoint begin, end;  // its corners in the unit cube
    double radius = 0;     // of the disk with the same area [m]

    /// Maps a point of the unit cube to a point of the patch, relative to the surface's centre [m].
    Vector3 at(const UnitPoint& place) const;
    /// The mean of its points, relative to the surface's centre [m].
    Vector3 middle() const;
    /// The covariance of its points about that mean [m^2].
    Matrix3 covariance() const;

    friend bool operator==(const LampPatch&, const LampPatch&) = default;
};

/// Divides a surface into a patch around, or close to, each of the points to which `places` map, by
/// recursive bisection in which each half has half of the points.
std::vector<LampPatch> divide(const LampFrame& frame, const Point3& centre,
                              const std::vector<UnitPoint>& places);

}  // namespace uw
