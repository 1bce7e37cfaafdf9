#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "render/assembled_scene.h"

namespace uw {

/// A lamp that represents the light of an emissive volume by a number of points, or casts the sky's
/// shadows by as many parts of it, and the error of that.
struct PointedLamp {
    std::size_t lamp = 0;   // index of the lamp
    std::size_t count = 0;  // of parts or points
    /// The change of its light in the image with four times as many: RMS over the image, relative
    /// to the mean of all light. It includes direct light and single scattering, but not what the
    /// water's surface mirrors. Still more points may change the image further.
    double change = 0;

    /// Whether the change is so large that the image should come with a note.
    bool matters() const { return change > 0.03; }
};

/// Finds the sky and each emissive volume, and computes their changes on a lattice of rays over the
/// image. Takes some tenths of a second, and no time if there are none.
std::vector<PointedLamp> find_pointed_lamps(const AssembledScene& scene);

/// Returns a note, one line, for each of `lamps` that matters, which says how to get more points.
std::vector<std::string> pointed_lamp_notes(const AssembledScene& scene,
                                            const std::vector<PointedLamp>& lamps);

}  // namespace uw
