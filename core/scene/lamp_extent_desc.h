#pragma once

namespace uw {

/// The luminous surface of a lamp that is not a point: flat, perpendicular to the lamp's direction,
/// with its centre at the lamp's position. Every point of it has the lamp's profile.
struct LampExtentDesc {
    enum class Shape { rectangle, disk };

    Shape shape = Shape::rectangle;
    double width = 0, height = 0;  ///< of a rectangle [m]
    /// Rotation of a rectangle about the lamp's direction [degrees], -360..360. At 0 its width lies
    /// along LampPlacement::across.
    double rotate = 0;
    double radius = 0;  ///< of a disk [m]
    int samples = 32;   ///< how many points stand for it, 1..1024

    friend bool operator==(const LampExtentDesc&, const LampExtentDesc&) = default;
};

}  // namespace uw
