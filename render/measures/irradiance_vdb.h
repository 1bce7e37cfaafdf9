#pragma once

#include <memory>
#include <vector>

#include "core/base/output_files.h"
#include "core/base/progress.h"
#include "core/light/integrator.h"
#include "render/scene_assembly.h"

namespace uw {

/// Throws InputError if nothing in `scene` determines where to sample its irradiance.
void check_irradiance_vdb(const AssembledScene& scene);

/// Writes a VDB file with the irradiance of each lamp and band on a surface facing the lamp [W
/// m^-2], with shadows and attenuation, as float grids "irradiance.<lamp>.<band>nm". Their lattice
/// covers the bounds of the volumes, or of all surfaces and lamps if there are no volumes. Voxels
/// are those of the finest grid, or so large that the longest side has at most 256 and all grids
/// together at most 2^28 values. Grids are in world space, y up as in the scene's world. `out`
/// remains to be committed. Throws IoError and Interrupted.
void write_irradiance_vdb(OutputFile& out, const AssembledScene& scene,
                          const std::vector<std::shared_ptr<const DeepShadow>>& deep_shadows,
                          const ProgressCallback& progress);

}  // namespace uw
