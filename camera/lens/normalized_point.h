#pragma once

namespace uw {

/// A place in the image in units of the focal length, from the principal point: where a pinhole
/// shows a ray (x, y, 1).
struct NormalizedPoint {
    double x = 0;
    double y = 0;
};

}  // namespace uw
