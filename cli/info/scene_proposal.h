#pragma once

#include <string>
#include <vector>

#include "core/base/ray.h"

namespace uw {

/// A lamp with a beam just wide enough for what it is aimed at.
struct ProposedLamp {
    std::string name;
    Point3 position;       // world [m]
    Vector3 direction;     // world, unit
    double beam = 0;       // full angle [degrees]
    double intensity = 0;  // on the axis [W/sr], the same in all bands
};

/// A view of what lies within a box: camera, lamps, a floor under it and the water.
struct SceneProposal {
    Point3 eye, target;
    std::vector<ProposedLamp> lamps;
    double floor = 0;   // world y [m]
    std::string water;  // preset
    double size = 0;    // of the box, by which lengths are rounded when written [m]
};

/// The camera that proposals have [pixels, degrees].
inline constexpr int k_proposed_width = 960, k_proposed_height = 540;
inline constexpr double k_proposed_fov = 60;

/// From the side on which the box is broad, a little above, so near that it just fits into nine
/// tenths of the picture. One lamp beside the camera and one behind the box, both out of the
/// picture, so that they light the box and little of the water before it.
SceneProposal propose_scene(const Bounds& bounds);

/// The scene file without its volumes: `uwvdb: 1`, camera, water, geometry and lamps.
std::string proposal_yaml(const SceneProposal& proposal);

/// A length, or three, as text: to a thousandth of `size`, however far from the origin.
std::string length_text(double length, double size);
std::string point_text(const Point3& point, double size);

}  // namespace uw
