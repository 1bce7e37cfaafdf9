#pragma once

#include <vector>

#include "core/base/csv_table.h"
#include "core/scene/species_desc.h"

namespace uw {

/// Volume scattering functions of a sample of water, by wavelength.
struct MeasuredVsf {
    std::vector<double> wavelengths_nm;  // ascending
    std::vector<SampledCurve> beta;      // per wavelength [1/(m sr)] by angle [degrees]
};

/// Reads the volume scattering functions of a species (SpeciesDesc::vsf), as they were measured.
/// Throws InputError at the species' place in the scene, IoError if the file cannot be read.
MeasuredVsf read_measured_vsf(const SpeciesDesc& species);

/// The volume scattering function of the particles alone at `wavelength_nm`, in water of `salinity`
/// [PSU]: molecular scattering is subtracted if it is included; then it is interpolated linearly
/// between the wavelengths, at the angles of the table, and constant beyond. Throws InputError if
/// the difference is negative.
SampledCurve particle_vsf(const MeasuredVsf& measured, const SpeciesDesc& species,
                          double wavelength_nm, double salinity);

}  // namespace uw
