#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/scene/water_desc.h"

namespace uw {

/// The properties of the water at each depth of a table, whose columns replace keys of the water.
struct DepthProfile {
    std::vector<double> depths;  // below the surface, ascending [m]
    /// Absorption of everything but particles, [depth * bands + band] [1/m]; empty: constant. From
    /// columns absorption or absorption_620, attenuation less scattering, chlorophyll and cdom.
    std::vector<double> absorption;
    /// Replaces ScatteringDesc::b, likewise. From columns scattering or scattering_620, or
    /// attenuation less absorption.
    std::vector<double> scattering;
    /// Concentrations by depth: Kopelevich's [ppm], empty if the table has none.
    std::vector<double> small, large;
    struct OfSpecies {
        std::size_t species = 0;
        std::vector<double> concentration;  // [unit_of(species)]
    };
    std::vector<OfSpecies> species;     // from columns "silt", "silt g/m3", ...
    std::vector<std::string> warnings;  // one line each, with the location in the scene file
};

/// Reads the water's profile, which it must have. Throws InputError at its place in the scene for a
/// table that is invalid and for columns whose key is also given; IoError if it cannot be read.
DepthProfile read_depth_profile(const WaterDesc& water);

/// Whether the profile has absorption or scattering as numbers by band.
bool profile_is_per_band(const WaterDesc& water);

}  // namespace uw
