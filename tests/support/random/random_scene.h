#pragma once

#include <cstdint>
#include <string>

namespace uw::test {

/// The text of a valid scene file of a few pixels, drawn at random: every kind of camera, port,
/// lens, sensor, water, snow, phase function, volume, shape, lamp, movement and integrator, and
/// some meshes, with values over all that is permitted rather than all that is likely. The same
/// number gives the same scene on every machine. Files are the project's assets.
std::string random_scene(std::uint64_t seed);

}  // namespace uw::test
