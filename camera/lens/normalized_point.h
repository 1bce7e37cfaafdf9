#pragma once

namespace uw {

/// A position in the image in units of the focal length, relative to the principal point: where a
/// pinhole images the direction (x, y, 1).
struct NormalizedPoint {
    double x = 0;
    double y = 0;
};

}  // namespace uw
