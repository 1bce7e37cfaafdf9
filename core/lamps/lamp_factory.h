#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/base/affine.h"
#include "core/lamps/lamp.h"
#include "core/scene/lamp_desc.h"

namespace uw {

/// Builds the lamp that `desc` describes for these bands: reads the files of its profile and its
/// spectrum, and converts lumens and candelas into watts. `world_from_camera` places lamps fixed to
/// the camera. Adds a one-line warning for an IES file whose candelas are inconsistent with its
/// lumens. Throws InputError, also for a spectrum if there is a single band, whose width is
/// undefined, and for a spectrum without light in any band; IoError for a file that cannot be read.
Lamp make_lamp(const LampDesc& desc, const Affine& world_from_camera,
               std::span<const double> bands_nm, std::vector<std::string>& warnings);

}  // namespace uw
