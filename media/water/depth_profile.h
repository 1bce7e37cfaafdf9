#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/scene/water_desc.h"

namespace uw {

/// What a table says of the water at each of its depths. Each column is in the place of a key of
/// the water.
struct DepthProfile {
    std::vector<double> depths;  // below the surface, ascending [m]
    /// Of everything but particles, [depth * bands + band] [1/m]; empty: it does not change. Of
    /// columns absorption or absorption_620, attenuation less scattering, chlorophyll and cdom.
    std::vector<double> absorption;
    /// In the place of ScatteringDesc::b, likewise. Of columns scattering or scattering_620, or
    /// attenuation less absorption.
    std::vector<double> scattering;
    /// Concentrations by depth: Kopelevich's [ppm], empty if the table has none.
    std::vector<double> small, large;
    struct OfSpecies {
        std::size_t species = 0;
        std::vector<double> concentration;  // [unit_of(species)]
    };
    std::vector<OfSpecies> species;     // of columns "silt", "silt g/m3", ...
    std::vector<std::string> warnings;  // one line each, with the location in the scene file
};

/// Reads the water's profile, which it must have. Throws InputError at its place in the scene for a
/// table that makes no sense and for columns whose key is given, too; IoError if it cannot be read.
DepthProfile read_depth_profile(const WaterDesc& water);

/// Whether the profile has absorption or scattering as numbers by band.
bool profile_is_per_band(const WaterDesc& water);

}  // namespace uw
