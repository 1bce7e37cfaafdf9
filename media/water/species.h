#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/light/medium.h"
#include "core/scene/water_desc.h"
#include "media/water/phase_functions.h"

namespace uw {

/// The phase function of a species at one wavelength.
class SpeciesPhase final : public TabulatedPhase {
  public:
    using TabulatedPhase::TabulatedPhase;
};

/// What as much of a species as unit_of says does to light of one wavelength.
struct SpeciesOptics {
    double absorption = 0, scattering = 0;  // [1/m per unit]
    std::shared_ptr<const PhaseFunction> phase;
};

/// Averages Lorenz-Mie scattering over a species' sizes, at `wavelength_nm` in vacuum, in water of
/// index `n_water`. Sizes are added until scattering and absorption hold to 1e-4 and the
/// phase function to 2 % at its angles in the root mean square, or there are 2048. Kept: the
/// same is not computed twice, nor what the cache of species holds (species_cache.h). `progress` is
/// told how far it is if it has to be computed. Throws InputError at the species' place in the
/// scene for tables that make no sense, IoError if they cannot be read.
SpeciesOptics species_optics(const SpeciesDesc& species, double wavelength_nm, double n_water,
                             const ProgressCallback& progress = {});

/// The same for any species in a scene's water: what was measured is interpolated linearly between
/// its wavelengths at each angle, without water's molecules, and held beyond its wavelengths;
/// Kopelevich's particles have his coefficients, one phase function at all wavelengths, and absorb
/// with WaterDesc::mineral_absorption.
SpeciesOptics species_optics(const SpeciesDesc& species, double wavelength_nm,
                             const WaterDesc& water, const ProgressCallback& progress = {});

/// How much work it is to find that: the most terms of Lorenz and Mie's series that are added up,
/// of all sizes, orders and angles. 0 for a species that is not computed.
double species_work(const SpeciesDesc& species, double wavelength_nm, const WaterDesc& water);

/// The species of a water, followed by those that every water has: Kopelevich's "small" and
/// "large".
std::vector<SpeciesDesc> all_species(const WaterDesc& water);

/// The wavelengths at which a species was measured [nm], ascending; empty if it was computed.
std::vector<double> measured_wavelengths(const SpeciesDesc& species);

/// The files that a species is read from.
std::vector<std::filesystem::path> files_of(const SpeciesDesc& species);

/// In what concentrations of a species are counted: "ppm" by volume, or the "sample" measured.
std::string unit_of(const SpeciesDesc& species);

/// A line that says how much of the volume of a log-normal size distribution without ends is in
/// particles too small or too large to be computed; none if that is less than 0.1 %.
std::optional<std::string> sizes_warning(const SpeciesDesc& species);

/// The concentration in that unit. 1 NTU is as much as scatters SpeciesDesc::ntu_scattering at 550
/// nm in this water.
double concentration_of(const SpeciesDesc& species, const SpeciesAmount& amount,
                        const WaterDesc& water);

}  // namespace uw
