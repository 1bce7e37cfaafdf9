#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "core/frame/render_film.h"
#include "render/scene_assembly.h"

namespace uw {

/// Throws InputError if `scene` says nowhere where its irradiance is to be sampled.
void check_irradiance_vdb(const AssembledScene& scene);

/// Writes the irradiance of each lamp and band on a surface that faces the lamp [W m^-2], with
/// shadows and attenuation, as float grids "irradiance.<lamp>.<band>nm" on a lattice over the
/// volumes' bounds (over all surfaces and lamps if there are no volumes). Voxels are the finest
/// grid's, or as large as keeps the longest side at 256 and all grids together at 2^28 values.
/// World space, y up as the scene's world. Throws IoError; Interrupted if `progress`, called from
/// any thread, returns false: then nothing has been written.
void write_irradiance_vdb(const std::filesystem::path& file, const AssembledScene& scene,
                          const std::vector<std::shared_ptr<const DeepShadowMap>>& deep_shadows,
                          const ProgressCallback& progress);

}  // namespace uw
