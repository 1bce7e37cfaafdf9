#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "core/light/medium.h"
#include "core/scene/species_desc.h"
#include "media/water/phase_functions.h"

namespace uw {

/// The phase function of a species at one wavelength.
class SpeciesPhase final : public TabulatedPhase {
  public:
    using TabulatedPhase::TabulatedPhase;
};

/// What particles of a species do to light of one wavelength.
struct SpeciesOptics {
    double absorption = 0, scattering = 0;  // [1/m per ppm by volume]
    std::shared_ptr<const PhaseFunction> phase;
};

/// Averages Lorenz-Mie scattering over a species' sizes, at `wavelength_nm` in vacuum, in water of
/// index `n_water`. Sizes are added until scattering and absorption hold to 1e-4 and the
/// phase function to 2 % at its angles in the root mean square, or there are 2048. Kept: the
/// same is not computed twice. Throws InputError at the species' place in the scene for tables
/// that make no sense, IoError if they cannot be read.
SpeciesOptics species_optics(const SpeciesDesc& species, double wavelength_nm, double n_water);

/// The files that a species is read from.
std::vector<std::filesystem::path> files_of(const SpeciesDesc& species);

/// The concentration in ppm by volume.
double parts_per_million(const SpeciesDesc& species, const SpeciesAmount& amount);

}  // namespace uw
