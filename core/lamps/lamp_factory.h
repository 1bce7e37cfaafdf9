#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/base/affine.h"
#include "core/lamps/lamp.h"
#include "core/scene/lamp_desc.h"

namespace uw {

/// Builds the lamp that `desc` describes for these bands: reads the files of its profile and its
/// spectrum, and turns lumens and candelas into watts. `world_from_camera` places lamps fixed to
/// the camera. An IES file whose candelas do not go with its lumens is warned of, one line each.
/// Throws InputError, also for a spectrum in one band, whose width nobody knows, and for one of
/// which no band sees anything; IoError for a file that cannot be read.
Lamp make_lamp(const LampDesc& desc, const Affine& world_from_camera,
               std::span<const double> bands_nm, std::vector<std::string>& warnings);

}  // namespace uw
