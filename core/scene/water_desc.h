#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/scene/forward_scatter_desc.h"
#include "core/scene/per_band.h"
#include "core/scene/phase_desc.h"
#include "core/scene/snow_desc.h"
#include "core/scene/source_location.h"
#include "core/scene/water_surface_desc.h"

namespace uw {

/// Scattering given as explicit coefficients.
struct ScatteringDesc {
    PerBand b;  ///< scattering coefficient [1/m], >= 0
    PhaseDesc phase;

    friend bool operator==(const ScatteringDesc&, const ScatteringDesc&) = default;
};

/// The homogeneous background water.
struct WaterDesc {
    std::vector<double> bands_nm{620, 540, 450};  ///< wavelengths of the scene's bands [nm]
    std::string preset;                           ///< a Jerlov water type, "jerlov-II"; empty: none
    double salinity = 35;                         ///< [PSU], 0..100
    double temperature = 20;                      ///< [degrees Celsius], -3..50
    std::optional<PerBand> absorption;  ///< of everything but particles [1/m]; else computed
    double cdom = 0;                    ///< absorption by dissolved matter at 440 nm [1/m]
    double chlorophyll = 0;             ///< [mg/m^3]
    /// Background particles [ppm by volume]; if omitted, the preset's, or none.
    std::optional<double> small_ppm, large_ppm;
    bool mineral_absorption = false;           ///< particles absorb as mineral sediment does
    std::optional<ScatteringDesc> scattering;  ///< instead of that of molecules and particles
    ForwardScatterDesc forward_scatter;
    std::optional<WaterSurfaceDesc> surface;  ///< above which there is no sunlight
    std::optional<SnowDesc> snow;
    SourceLocation where;

    friend bool operator==(const WaterDesc&, const WaterDesc&) = default;
};

}  // namespace uw
