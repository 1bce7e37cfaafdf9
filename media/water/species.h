#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/light/medium.h"
#include "core/scene/water_desc.h"
#include "media/water/tabulated_phase.h"

namespace uw {

/// The phase function of a species at one wavelength.
class SpeciesPhase final : public TabulatedPhase {
  public:
    using TabulatedPhase::TabulatedPhase;
};

/// The optical properties of a unit (unit_of) of a species at one wavelength.
struct SpeciesOptics {
    double absorption = 0, scattering = 0;  // [1/m per unit]
    std::shared_ptr<const PhaseFunction> phase;
};

/// Averages Lorenz-Mie scattering over a species' sizes, at `wavelength_nm` in vacuum, in water of
/// index `n_water`. Sizes are added until scattering and absorption are accurate to 1e-4 and the
/// phase function to 2 % (root mean square over its angles), or there are 2048. Results are kept,
/// in memory and in the cache of species (species_cache.h). `progress` is called if they have to be
/// computed. Throws InputError at the species' place in the scene for invalid tables, IoError if
/// they cannot be read.
SpeciesOptics species_optics(const SpeciesDesc& species, double wavelength_nm, double n_water,
                             const ProgressCallback& progress = {});

/// The same for any species in a scene's water: measured functions are interpolated linearly
/// between their wavelengths at each angle, without water's molecules, and constant beyond;
/// Kopelevich's particles have his coefficients, one phase function at all wavelengths, and absorb
/// with WaterDesc::mineral_absorption.
SpeciesOptics species_optics(const SpeciesDesc& species, double wavelength_nm,
                             const WaterDesc& water, const ProgressCallback& progress = {});

/// The cost of computing that: the greatest number of terms of the Lorenz-Mie series, over all
/// sizes, orders and angles. 0 for a species that is not computed.
double species_work(const SpeciesDesc& species, double wavelength_nm, const WaterDesc& water);

/// The species of a water, followed by Kopelevich's "small" and "large", which every water has.
std::vector<SpeciesDesc> all_species(const WaterDesc& water);

/// The wavelengths at which a species was measured [nm], ascending; empty if it was computed.
std::vector<double> measured_wavelengths(const SpeciesDesc& species);

/// The files from which a species is read.
std::vector<std::filesystem::path> files_of(const SpeciesDesc& species);

/// The unit of a species' concentrations: "ppm" by volume, or the "sample" measured.
std::string unit_of(const SpeciesDesc& species);

/// A line that states which fraction of the volume of a log-normal size distribution without ends
/// is in particles too small or too large to be computed; none if that is less than 0.1 %.
std::optional<std::string> sizes_warning(const SpeciesDesc& species);

/// The concentration in that unit. 1 NTU is the concentration whose scattering at 550 nm in this
/// water is SpeciesDesc::ntu_scattering.
double concentration_of(const SpeciesDesc& species, const SpeciesAmount& amount,
                        const WaterDesc& water);

}  // namespace uw
