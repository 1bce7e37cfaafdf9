#pragma once

#include <string>
#include <vector>

#include "core/optics/grid_load.h"
#include "core/optics/medium.h"
#include "core/scene/volume_desc.h"
#include "core/scene/water_desc.h"

namespace uw {

/// The water of a scene, ready to render, and what its grids add to it.
struct WaterModel {
    Medium medium;
    std::vector<std::vector<std::vector<GridLoad>>> loads;  // [volume][grid mapping]
    double small_ppm = 0, large_ppm = 0;  // background particles, part of medium.uniform
    std::vector<std::string> warnings;    // one line each, with the place in the scene file
};

/// Builds the optical properties of the water (physics section 1; docs/physics.md).
///
/// Absorption everywhere: `water.absorption`, or the preset's, or pure water's at the water's
/// temperature and salinity; to the latter two cdom and chlorophyll are added.
/// Scattering everywhere: `water.scattering` with its one phase function, or else molecules and
/// Kopelevich particles, in the preset's concentrations where the scene gives none. Particles
/// absorb only with `mineral_absorption`; what a preset's own particles absorb is in its measured
/// absorption already and is not added again.
/// Grids: particles add to the constituents "small" and "large" [ppm]; each set of own optics is a
/// constituent [per unit of grid value] named after its first grid. Optics without a phase function
/// scatter as the uniform water does in each band, molecules included.
/// Phase functions and constituents that nothing uses are left out.
///
/// Throws InputError starting with the place in the scene file: unknown preset, a band outside
/// pure water's table (300 to 900 nm) without explicit absorption, optics without a phase function
/// in water that does not scatter, and what make_phase_function refuses.
WaterModel build_water_model(const WaterDesc& water, const std::vector<VolumeDesc>& volumes);

}  // namespace uw
