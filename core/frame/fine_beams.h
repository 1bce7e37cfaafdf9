#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/base/ray_source.h"
#include "core/lamps/lamp.h"

namespace uw {

/// A rectangle of the image [pixels].
struct ImageRectangle {
    double x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

/// The beams of lamps as narrow things in an image, such as a laser's line: rays that are some
/// pixels apart may pass them on both sides.
class FineBeams {
  public:
    /// `rays` must outlive this object.
    FineBeams(const RaySource& rays, const std::vector<Lamp>& emitters);

    /// From here on, has_any() is asked for parts of `area` and for this `width` at most.
    void begin(const ImageRectangle& area, double width, double reach);

    /// Whether a beam that is narrower than `width` pixels there is seen in `area`, or may be, up
    /// to the distance `reach` of begin() [m].
    bool has_any(const ImageRectangle& area, double width) const;

  private:
    /// Where the intensity is more than half of the greatest, and where it matters.
    struct Beam {
        Point3 apex;
        Vector3 axis;                    // unit
        double core_slope, outer_slope;  // tangents of the angles from the axis
    };
    /// The rays of a rectangle.
    struct Bundle {
        Point3 origin;
        Vector3 direction;                // of the ray in the middle
        std::array<Vector3, 4> outwards;  // normals of its sides
        std::array<double, 4> offsets;    // inside: dot(outwards, x) <= offset
        double pixel = 0;                 // width of a pixel, per metre of distance
    };

    static std::optional<Beam> beam_of(const Lamp& emitter);
    std::optional<Bundle> bundle(const ImageRectangle& area) const;
    bool is_fine_in(const Bundle& bundle, const Beam& beam, double width) const;

    const RaySource& rays_;
    std::vector<Beam> beams_;
    std::vector<const Beam*> near_;  // those of begin()
    double reach_ = 0;
};

}  // namespace uw
