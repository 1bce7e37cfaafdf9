#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/scene/config_value.h"
#include "core/scene/scene_context.h"

namespace uw {

/// The diameters of particles of a species are from here to there [m].
inline constexpr double k_min_diameter = 10e-9, k_max_diameter = 5e-3;

/// How the diameters of a species' particles are distributed. f(D) dD is the number of particles
/// with diameters in dD, up to a factor.
struct SizesDesc {
    enum class Type : std::uint8_t {
        junge,      // f = D^-exponent
        lognormal,  // ln D normal about ln median with deviation ln sigma
        gamma,      // f = D^exponent e^(-exponent D / mode)
        table       // volume per class of a particle sizer, in a file
    };
    Type type = Type::junge;
    /// Diameters [m]. 0: of a table, its own; a log-normal distribution has none, and
    /// concentrations by number count all of it.
    double least = 0, greatest = 0;
    double exponent = 4;
    double median = 0, sigma = 2;  ///< by number [m], > 1
    double mode = 0;               ///< the most frequent diameter [m]
    std::filesystem::path file;    ///< CSV with columns diameter_um,volume

    friend bool operator==(const SizesDesc&, const SizesDesc&) = default;
};

/// A refractive index relative to the water's, n + i k.
struct ParticleIndexDesc {
    double n = 1, k = 0;
    double k_slope = 0;          ///< k e^(-k_slope (lambda - 550 nm)) is that at lambda [1/nm]
    std::filesystem::path file;  ///< instead: CSV with columns wavelength_nm,n,k

    friend bool operator==(const ParticleIndexDesc&, const ParticleIndexDesc&) = default;
};

/// How much of a species there is, or comes with a unit of a grid's value.
struct SpeciesAmount {
    enum class Unit : std::uint8_t {
        own,     // ppm by volume; of a measured species, times as much as there was in the sample
        grams,   // [g/m^3]
        number,  // [1/m^3]
        ntu      // nephelometric turbidity units, and FTU and FNU
    };
    std::size_t species = 0;  ///< index into WaterDesc::species
    double amount = 0;        ///< >= 0
    Unit unit = Unit::own;

    friend bool operator==(const SpeciesAmount&, const SpeciesAmount&) = default;
};

/// The two classes of particles of Kopelevich's model (1983; Mobley 1994, section 3.8).
enum class KopelevichClass : std::uint8_t {
    small,  // mineral
    large   // organic
};

/// Density of Kopelevich's particles [g/cm^3], which is also the mass of one ppm by volume [g/m^3].
inline constexpr double k_small_particle_density = 2;
inline constexpr double k_large_particle_density = 1;

/// The volume scattering function of a sample of water, as it was measured.
struct MeasuredVsfDesc {
    std::filesystem::path file;  ///< CSV with columns angle_deg and beta_NM [1/(m sr)] for each NM
    std::string library;         ///< instead: the name of one of Petzold's waters
    bool has_water = false;      ///< water's molecules scatter in it, too
    /// What was in the sample; `species` is not used. None: it is not known.
    std::optional<SpeciesAmount> sample;
    double absorption = 0;                  ///< by the particles in the sample [1/m]
    std::filesystem::path absorption_file;  ///< instead: CSV with columns wavelength_nm,absorption

    friend bool operator==(const MeasuredVsfDesc&, const MeasuredVsfDesc&) = default;
};

/// Particles whose optical properties follow from their sizes and their refractive index
/// (Lorenz-Mie, for spheres of the same volume), were measured, or are those of Kopelevich's model.
struct SpeciesDesc {
    std::string name;
    std::optional<MeasuredVsfDesc> vsf;         ///< in place of sizes, index, density and coat
    std::optional<KopelevichClass> kopelevich;  ///< in place of sizes, index and coat
    SizesDesc sizes;
    ParticleIndexDesc index;
    double ntu_scattering = 1;      ///< b at 550 nm of as much as has 1 NTU [1/m]
    std::optional<double> density;  ///< [g/cm^3]
    struct Coat {
        double thickness = 0;  ///< [m], part of the diameter
        ParticleIndexDesc index;

        friend bool operator==(const Coat&, const Coat&) = default;
    };
    std::optional<Coat> coat;
    SourceLocation where;

    friend bool operator==(const SpeciesDesc&, const SpeciesDesc&) = default;
};

/// Particles of Kopelevich's model.
SpeciesDesc kopelevich_species(KopelevichClass kind, std::string name, SourceLocation where);

/// Reads a diameter or thickness [m] from `least` to `greatest`: a number of metres, or one with a
/// unit, "0.2 mm".
double read_diameter(const ConfigValue& value, double least, double greatest);

/// Reads the two ends of a range of diameters, "[0.2 mm, 5 mm]", the first less than the second.
void read_diameters(const ConfigValue& value, double least, double greatest, double& first,
                    double& last);

/// Reads `water.species`, a map of names. Throws InputError also for names that mean something else
/// where concentrations are given.
std::vector<SpeciesDesc> read_species(const ConfigValue& value, const SceneContext& context);

/// The names of `species`, in their order.
std::vector<std::string_view> names_of(const std::vector<SpeciesDesc>& species);

/// The amount and unit that a text gives, of species 0: "2", "3 g/m3", "1e6 /m3", "4 NTU"; none if
/// it is no amount.
std::optional<SpeciesAmount> parse_amount(std::string_view text);

/// How much of species number `index` a text gives. Throws InputError at `where` for what is no
/// such amount, and for units that need what the species lacks.
SpeciesAmount read_amount(std::string_view text, std::size_t index, const SpeciesDesc& species,
                          const SourceLocation& where);

/// Takes what `map` gives of `species`, as "NAME: 2", "NAME: 3 g/m3", "NAME: 1e6 /m3" or "NAME: 4
/// NTU".
std::vector<SpeciesAmount> read_amounts(ConfigMap& map, const std::vector<SpeciesDesc>& species);

}  // namespace uw
