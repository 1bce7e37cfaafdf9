#pragma once

#include <cstddef>
#include <vector>

#include "core/base/affine.h"
#include "core/lamps/lamp.h"
#include "core/scene/lamp_desc.h"

namespace uw {

/// Appends the points that `lamp`, made of `desc`, consists of: itself, or, if it has an extent,
/// points that fill that evenly and share its light equally, or of a sun with an angle directions
/// that fill its disc evenly. They are the same ones in every render: shadows become as many steps.
/// `index`: of the lamp in the scene. `thinning`: of the extent's samples only every so many-th is
/// made, at least one. `world_from_camera` places lamps fixed to the camera.
///
/// The points are a golden-ratio lattice, on a disk with area in the place of its first coordinate
/// (Vogel's spiral), moved so that their mean is the centre. With N of them, what varies smoothly
/// over the lamp is off by about 1/N^2, and the light in a penumbra by about 0.7/N of the lamp's
/// (RMS), 2.4/N at worst, for N = 32.
void append_emitters(const LampDesc& desc, const Lamp& lamp, std::size_t index, int thinning,
                     const Affine& world_from_camera, std::vector<Lamp>& emitters);

}  // namespace uw
