#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/base/error.h"
#include "core/base/vector_math.h"
#include "core/scene/config_value.h"
#include "core/scene/scene_context.h"
#include "core/scene/species_desc.h"

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
/// media/water/phase_functions.h constructs them, core/scene/water_desc.h reads the
/// descriptions; neither compiles unless it handles all of them.
using PhaseFunctionDesc = std::variant<HenyeyGreensteinDesc, FournierForandDesc, PetzoldDesc,
                                       TabulatedPhaseDesc, MolecularPhaseDesc>;

/// The phase function of one scatterer.
struct PhaseDesc {
    PhaseFunctionDesc function;  ///< isotropic by default
    SourceLocation where;

    friend bool operator==(const PhaseDesc&, const PhaseDesc&) = default;
};

/// Light that is blurred by scattering through small angles (docs/physics.md, section 6).
struct ForwardScatterDesc {
    /// The shape of the blur's spectrum.
    enum class Shape { gaussian, exponential };
    double K = 0;  ///< strength, >= 0; 0: no forward scatter
    double G = 0;  ///< attenuation of the forward-scattered light [1/m], |G| <= c
    double B = 0;  ///< width >= 0: the spectrum falls as e^{-B R f}, f in cycles/rad [rad/m]
    Shape shape = Shape::gaussian;
    SourceLocation where = "water.forward_scatter";

    friend bool operator==(const ForwardScatterDesc&, const ForwardScatterDesc&) = default;
};

/// Marine snow: discrete particles, drawn one by one (docs/snow.md).
struct SnowDesc {
    /// How the particles' mean is related to the water's coefficients: these include it already, or
    /// the snow's own coefficients are added to them.
    enum class Mean { included, added };

    double number = 0;  ///< of all diameters below, per m^3, > 0
    /// Diameters of spheres with the particles' cross section, least < greatest [m].
    double least = 0, greatest = 0;
    /// Junge's: the number per interval of diameters dD is proportional to D^-exponent dD.
    double exponent = 4;
    PerBand reflectance;     ///< of the particles' white diffuse surface, 0..1
    Vector3 drift{0, 0, 0};  ///< velocity of all particles [m/s], world
    std::uint64_t seed = 0;
    Mean mean = Mean::included;
    /// Whether depth, position, normal and id are those of a particle that covers most of a pixel.
    bool in_ground_truth = false;
    int most = 1'000'000;  ///< approximate number of particles drawn in an image; the mean replaces
                           ///< the others
    SourceLocation where;

    friend bool operator==(const SnowDesc&, const SnowDesc&) = default;
};

/// Scattering given as explicit coefficients.
struct ScatteringDesc {
    PerBand b;  ///< scattering coefficient [1/m], >= 0
    PhaseDesc phase;
    bool is_by_depth = false;  ///< b is the profile's instead

    friend bool operator==(const ScatteringDesc&, const ScatteringDesc&) = default;
};

/// Properties that vary with depth: a table whose columns replace keys of the water.
struct DepthProfileDesc {
    std::filesystem::path file;  ///< CSV (media/water/depth_profile.h)
    SourceLocation where;

    friend bool operator==(const DepthProfileDesc&, const DepthProfileDesc&) = default;
};

/// The background water.
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
    std::vector<SpeciesDesc> species;          ///< that concentrations can name besides these
    std::vector<SpeciesAmount> amounts;        ///< background concentrations of them
    bool mineral_absorption = false;           ///< particles absorb as mineral sediment does
    std::optional<ScatteringDesc> scattering;  ///< instead of that of molecules and particles
    ForwardScatterDesc forward_scatter;
    std::optional<DepthProfileDesc> profile;  ///< needs `surface`, from which depths count
    std::optional<WaterSurfaceDesc> surface;  ///< above which there is no sunlight
    std::optional<SnowDesc> snow;
    SourceLocation where;

    friend bool operator==(const WaterDesc&, const WaterDesc&) = default;
};

/// `phase` of the water's scattering or of a grid.
PhaseDesc read_phase(const ConfigValue& value, const SceneContext& context);

/// `water`; also sets the number of bands for the sections that follow.
WaterDesc read_water(const ConfigValue& value, SceneContext& context);

}  // namespace uw
