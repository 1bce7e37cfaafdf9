#pragma once

#include <string>
#include <vector>

#include "camera/camera.h"

namespace uw {

/// Corners of boards in photographs through a port: how far from where they were found in the
/// photographs the camera model has them [px]. All lists are in the order of the corners.
struct PortPhotographs {
    std::string source;     // "14 photographs through a flat port"
    std::string port_name;  // "flat port"
    /// Root mean squares that an independent model of camera and ports found for the same corners
    /// [px]: with the port; with a plain lens in its place, the boards posed anew; and of
    /// photographs in air, the noise of corners (0: there are none).
    double published_port = 0, published_plain = 0, published_air = 0;
    /// Of half a unit of the last digit of `published_plain` [px].
    double plain_rounding = 0;
    std::vector<ImagePoint> port;   // with the port
    std::vector<ImagePoint> plain;  // without, and the boards of each photograph moved to fit best
};

/// Root mean square length [px].
double rms_of(const std::vector<ImagePoint>& residuals);

/// Three sets: through a flat port, through a dome, and through a tank of water. The boards'
/// poses, and the thickness of the tank, are those that the independent model found. The plain lens
/// has, in each photograph, the rigid motion of all boards that fits best, by least squares
/// (Levenberg 1944, Marquardt 1963).
std::vector<PortPhotographs> photographs_through_ports();

}  // namespace uw
