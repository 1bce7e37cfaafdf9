#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "cli/scene_assembly.h"

namespace uw {

/// Writes the irradiance of each lamp and band on a surface that faces the lamp [W m^-2], with
/// shadows and attenuation, as float grids "irradiance.<lamp>.<band>nm" on a lattice over the
/// volumes' bounds (over all surfaces and lamps if there are no volumes). Voxels are the finest
/// grid's, or as large as keeps the longest side at 256. World space, y up as the scene's world.
/// Throws IoError.
void write_irradiance_vdb(const std::filesystem::path& file, const AssembledScene& scene,
                          const std::vector<std::shared_ptr<const LampLightField>>& light_fields);

}  // namespace uw
