#pragma once

#include "media/light/cube_face.h"

namespace uw {

/// A rectangle of directions on one cube face, within [-1, 1]^2.
struct FaceRectangle {
    double u_min = 1, u_max = -1;
    double v_min = 1, v_max = -1;

    bool empty() const { return u_min > u_max || v_min > v_max; }
};

/// The smallest rectangle on `face` that contains all directions from `center` that hit `box`: the
/// box clipped to the pyramid of the face and projected. Empty if none does; the whole face if
/// `center` lies in the box.
FaceRectangle project_box(const Bounds& box, const Point3& center, const CubeFace& face);

/// The integral over the directions of `rectangle`, du dv, of the length inside `box` of their rays
/// from `center` [m].
double integrate_chords(const Bounds& box, const Point3& center, const CubeFace& face,
                        const FaceRectangle& rectangle);

}  // namespace uw
