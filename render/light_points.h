#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "render/assembled_scene.h"

namespace uw {

/// A lamp that stands for light from all over the sky, or from all over a volume, as so many
/// directions or points, and what that leaves out.
struct PointedLamp {
    std::size_t lamp = 0;   // its index
    std::size_t count = 0;  // of directions or points
    /// By how much its light in the image changes with four times as many: RMS over the image,
    /// relative to the mean of all light in it, of single scattering and direct light, without what
    /// the water's surface mirrors. What more of them than that would change comes on top.
    double change = 0;

    /// Whether that is more than an image may leave out without a word.
    bool matters() const { return change > 0.03; }
};

/// Finds it for the sky and each volume that gives off light, at a lattice of rays over the image:
/// tenths of a second, and nothing where there is none of them.
std::vector<PointedLamp> find_pointed_lamps(const AssembledScene& scene);

/// One line for each of `lamps` that matters, and how to have more points.
std::vector<std::string> pointed_lamp_notes(const AssembledScene& scene,
                                            const std::vector<PointedLamp>& lamps);

}  // namespace uw
