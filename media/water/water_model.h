#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/light/medium.h"
#include "core/scene/volume_desc.h"
#include "core/scene/water_desc.h"

namespace uw {

/// The water of a scene, ready to render, and the contributions of its grids.
struct WaterModel {
    Medium medium;
    std::vector<std::vector<std::vector<GridLoad>>> loads;  // [volume][grid mapping]
    double small_ppm = 0, large_ppm = 0;   // background particles, part of medium.uniform
    std::shared_ptr<const Strata> strata;  // of the depth profile; null if nothing varies
    std::vector<std::string> warnings;     // one line each, with the location in the scene file
};

/// Builds the optical properties of the water (physics section 1; docs/physics.md).
///
/// Uniform absorption: `water.absorption`, or the preset's, or pure water's at the water's
/// temperature and salinity; cdom and chlorophyll are added to the latter two.
/// Uniform scattering: `water.scattering` with its single phase function, or else molecules and
/// Kopelevich particles, at the preset's concentrations unless the scene gives them. Particles
/// absorb only with `mineral_absorption`; the absorption of a preset's own particles is already
/// included in its measured absorption and is not added again.
/// Species (Lorenz-Mie) have a phase function per band, and come with the absorption of their own
/// index. Grids: particles add to the constituents "small", "large" and those named as species
/// [ppm]; each distinct set of optical coefficients is a constituent [per unit of grid value] named
/// after its first grid. Coefficients without a phase function scatter like the uniform water in
/// each band, molecules included. Unused phase functions and constituents are omitted.
///
/// A depth profile's least values are part of the uniform water; the excess over them at each depth
/// is part of the constituents: particles of those to which grids add, absorption and scattering of
/// "absorption" and "scattering" [1/m], one for each band unless all bands vary alike.
///
/// `progress` is called with the progress of computing species, if any takes time.
///
/// Throws InputError starting with the location in the scene file: unknown preset, a band outside
/// pure water's table (300 to 900 nm) without explicit absorption, coefficients without a phase
/// function in water that does not scatter, and whatever make_phase_function rejects.
WaterModel build_water_model(const WaterDesc& water, const std::vector<VolumeDesc>& volumes,
                             const ProgressCallback& progress = {});

/// The coefficients of the water at the depths of the model's strata, in their order, without the
/// grids; none without strata.
std::vector<OpticalCoefficients> coefficients_by_depth(const WaterModel& model);

/// The water's own particles (WaterDesc::small_ppm, large_ppm).
enum class WaterParticles : std::uint8_t { small, large };

/// Returns the medium of `model`, the water that these descriptions say, with one ppm more of these
/// particles in its uniform part. The change is the derivative by their concentration, in which the
/// coefficients are linear: upwards, where mineral absorption begins at the preset's own. If the
/// particles are new to the medium, their phase function follows its own. UsageError if the water's
/// scattering is given, so that it has no particles, if these change with depth, or if a grid
/// scatters like the water, whose phase function they change.
Medium with_one_more_ppm(const WaterModel& model, const WaterDesc& water,
                         const std::vector<VolumeDesc>& volumes, WaterParticles particles);

}  // namespace uw
