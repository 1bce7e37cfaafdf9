#pragma once

#include <filesystem>
#include <variant>

#include "core/scene/source_location.h"

namespace uw {

/// The Henyey-Greenstein phase function.
struct HenyeyGreensteinDesc {
    double g = 0;  ///< mean cosine of the scattering angle, -1 < g < 1; 0: isotropic

    friend bool operator==(const HenyeyGreensteinDesc&, const HenyeyGreensteinDesc&) = default;
};

/// The Fournier-Forand phase function of particles.
struct FournierForandDesc {
    double n = 1.10;     ///< refractive index of the particles relative to water, > 1
    double mu = 3.5835;  ///< slope of their hyperbolic (Junge) size distribution, 3 < mu < 5

    friend bool operator==(const FournierForandDesc&, const FournierForandDesc&) = default;
};

/// Petzold's average particle phase function.
struct PetzoldDesc {
    friend bool operator==(const PetzoldDesc&, const PetzoldDesc&) = default;
};

/// A phase function from a table.
struct TabulatedPhaseDesc {
    std::filesystem::path file;  ///< CSV with columns angle_deg,phase

    /// Two spellings of the same path are the same phase function.
    friend bool operator==(const TabulatedPhaseDesc& a, const TabulatedPhaseDesc& b) {
        return a.file.lexically_normal() == b.file.lexically_normal();
    }
};

/// Scattering by the molecules of water and its salts.
struct MolecularPhaseDesc {
    friend bool operator==(const MolecularPhaseDesc&, const MolecularPhaseDesc&) = default;
};

/// Every phase function that a scene can name. Equal descriptions are the same phase function.
/// media/phase/phase_factory.h constructs them, core/scene/yaml/phase_reader.h reads the
/// descriptions; neither compiles unless it handles all of them.
using PhaseFunctionDesc = std::variant<HenyeyGreensteinDesc, FournierForandDesc, PetzoldDesc,
                                       TabulatedPhaseDesc, MolecularPhaseDesc>;

/// The phase function of one scatterer.
struct PhaseDesc {
    PhaseFunctionDesc function;  ///< isotropic by default
    SourceLocation where;

    friend bool operator==(const PhaseDesc&, const PhaseDesc&) = default;
};

}  // namespace uw
