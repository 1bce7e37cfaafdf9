#pragma once

#include <cstdint>

#include "render/image_scene.h"

namespace uw::test {

/// What became of the scenes of some seeds.
struct InvariantCounts {
    int rendered = 0;
    int refused = 0;   // by a message of one line
    int left_out = 0;  // as `Scattered` says
    int compared = 0;  // pixels held against the reference integrator
    int bounded = 0;   // pixels and bands whose in-scatter has a bound (light_bounds.h)
    // The scene that took the most time, to be printed, not judged:
    std::uint64_t slowest_seed = 0;
    double slowest_cpu_seconds = 0;
};

/// Renders a scene and holds its image to what every image has to fulfil, whatever it shows:
/// - all values are finite, and light is not negative;
/// - direct, forward, backscatter and multiple sum to the total;
/// - the share of lamps that light a point, transmittances and albedos are within 0..1, and direct
///   light is not more than there would be without water in between;
/// - a surface gets, and uniform water scatters once, no more light than the lamps could give were
///   there nothing else (light_bounds.h);
/// - a sensor's numbers are within its bits;
/// - three threads give the bytes of one, and a part of the image is that part of the whole;
/// - the fast integrator agrees with the reference at two pixels.
void hold_image(const ImageScene& scene, InvariantCounts& counts);

}  // namespace uw::test
