#pragma once

#include <cstdint>

namespace uw::test {

/// What became of the scenes of some seeds.
struct InvariantCounts {
    int rendered = 0;
    int refused = 0;   // by a message of one line
    int left_out = 0;  // as `Scattered` says
    int compared = 0;  // pixels held against the reference integrator
};

/// Multiple scattering takes seconds for a scene, all else tenths of a second.
enum class Scattered { once, any };

/// Renders random_scene of `count` seeds from `first` on and holds each image to what every image
/// has to fulfil, whatever it shows; a failure names the seed:
/// - all values are finite, and light is not negative;
/// - direct, forward, backscatter and multiple sum to the total;
/// - the share of lamps that light a point, transmittances and albedos are within 0..1, and direct
///   light is not more than there would be without water in between;
/// - a surface gets no more light than point lamps could send it with nothing in between;
/// - three threads give the bytes of one, and a part of the image is that part of the whole;
/// - the fast integrator agrees with the reference at two pixels.
InvariantCounts hold_invariants(std::uint64_t first, int count, Scattered scattered);

}  // namespace uw::test
