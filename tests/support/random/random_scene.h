#pragma once

#include <cstdint>
#include <string>

namespace uw::test {

/// The text of a valid scene file of 16 x 9 pixels, drawn at random: every kind of camera, port,
/// water, phase function, volume, shape, lamp and integrator, with values over all that is
/// permitted rather than all that is likely. The same number gives the same scene on every machine.
/// Files are the project's assets.
std::string random_scene(std::uint64_t seed);

}  // namespace uw::test
