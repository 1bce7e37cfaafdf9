#include "media/water/water_types.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/csv_table.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "media/water/molecular_phase.h"

namespace uw {

namespace {

struct AbsorptionTable {
    SampledCurve a, per_salinity, per_temperature;
};

const AbsorptionTable& absorption_table() {
    static const AbsorptionTable k_table = [] {
        const CsvTable csv = read_embedded_table("pure_water_absorption_wopp2016.csv");
        return AbsorptionTable{csv.curve("wavelength_nm", "a_w_per_m"),
                               csv.curve("wavelength_nm", "dadS"),
                               csv.curve("wavelength_nm", "dadT")};
    }();
    return k_table;
}

}  // namespace

WavelengthRange pure_water_absorption_range() {
    const SampledCurve& a = absorption_table().a;
    return {a.first(), a.last()};
}

double pure_water_absorption(double wavelength_nm, double temperature, double salinity) {
    const AbsorptionTable& table = absorption_table();
    if (!table.a.covers(wavelength_nm))
        throw InputError(
            fmt::format("the absorption of pure water is known from {} to {} nm, not at {} nm; "
                        "choose a band within that range, or give the absorption",
                        table.a.first(), table.a.last(), wavelength_nm));
    return std::max(0.0, table.a.value(wavelength_nm) +
                             (temperature - 20) * table.per_temperature.value(wavelength_nm) +
                             salinity * table.per_salinity.value(wavelength_nm));
}

double water_vsf_90(double wavelength_nm, double salinity) {
    return 1.38e-4 * (1 + 0.3 * salinity / 37) * std::pow(500 / wavelength_nm, 4.32);
}

double water_scattering(double wavelength_nm, double salinity) {
    return 4 * std::numbers::pi * (1 + MolecularPhase::k_anisotropy / 3) *
           water_vsf_90(wavelength_nm, salinity);
}

namespace {

struct BricaudTable {
    SampledCurve factor, exponent;
};

const BricaudTable& bricaud_table() {
    static const BricaudTable k_table = [] {
        const CsvTable csv = read_embedded_table("bio_optical_tables_5nm.csv");
        return BricaudTable{csv.curve("wavelength_nm", "A_bricaud"),
                            csv.curve("wavelength_nm", "B_bricaud")};
    }();
    return k_table;
}

}  // namespace

double cdom_absorption(double wavelength_nm, double a_440) {
    return a_440 * std::exp(-0.014 * (wavelength_nm - 440));
}

WavelengthRange chlorophyll_absorption_range() {
    const SampledCurve& factor = bricaud_table().factor;
    return {factor.first(), factor.last()};
}

double chlorophyll_absorption(double wavelength_nm, double chlorophyll) {
    const BricaudTable& table = bricaud_table();
    return table.factor.value(wavelength_nm) *
           std::pow(chlorophyll, 1 - table.exponent.value(wavelength_nm));
}

double kopelevich_small_scattering(double wavelength_nm) {
    return 1.34 * std::pow(550 / wavelength_nm, 1.7);
}

double kopelevich_large_scattering(double wavelength_nm) {
    return 0.312 * std::pow(550 / wavelength_nm, 0.3);
}

double mineral_mass_absorption(double wavelength_nm) {
    return 0.041 * std::exp(-0.0123 * (wavelength_nm - 443));
}

namespace {

// Assumed state of the water in the measurements.
constexpr double k_reference_temperature = 20;
constexpr double k_reference_salinity = 35;

JerlovPreset make_preset(const CsvTable& measured, const std::string& type, double cs, double cl) {
    SampledCurve excess = measured.where("water_type", type).curve("wavelength_nm", "a_per_m");
    for (std::size_t i = 0; i < excess.x.size(); ++i)
        excess.y[i] -=
            pure_water_absorption(excess.x[i], k_reference_temperature, k_reference_salinity);
    // The two-component model's Cs and Cl are mass concentrations [g/m^3].
    const WavelengthRange range{excess.first(), excess.last()};
    return {"jerlov-" + type, range, std::move(excess), cs / k_small_particle_density,
            cl / k_large_particle_density};
}

const std::vector<JerlovPreset>& presets() {
    static const std::vector<JerlovPreset> k_presets = [] {
        const CsvTable measured =
            read_embedded_table("jerlov_iop_williamson_hollins2022_measured.csv");
        const CsvTable model = read_embedded_table("jerlov_b_williamson_hollins2022_model.csv");
        const std::vector<std::string> types = model.text("water_type");
        const std::vector<double> cs = model.numbers("Cs_fit");
        const std::vector<double> cl = model.numbers("Cl_fit");
        std::vector<JerlovPreset> all;
        for (std::size_t i = 0; i < types.size(); ++i)
            all.push_back(make_preset(measured, types[i], cs[i], cl[i]));
        return all;
    }();
    return k_presets;
}

}  // namespace

std::vector<std::string> jerlov_preset_names() {
    std::vector<std::string> names;
    for (const JerlovPreset& preset : presets()) names.push_back(preset.name);
    return names;
}

const JerlovPreset& jerlov_preset(std::string_view name) {
    for (const JerlovPreset& preset : presets())
        if (same_ignoring_case(preset.name, name)) return preset;
    throw InputError(fmt::format("unknown preset '{}'; the presets are {}", name,
                                 fmt::join(jerlov_preset_names(), ", ")));
}

double jerlov_absorption(const JerlovPreset& preset, double wavelength_nm, double temperature,
                         double salinity) {
    double excess = preset.excess_absorption.value(wavelength_nm);
    if (!preset.measured.contains(wavelength_nm)) excess = std::max(0.0, excess);
    return std::max(0.0, pure_water_absorption(wavelength_nm, temperature, salinity) + excess);
}

namespace {

/// The bands outside `range` as "620, 700", empty if there are none.
std::string bands_outside(const WaterDesc& water, const WavelengthRange& range) {
    std::string outside;
    for (const double band : water.bands_nm)
        if (!range.contains(band))
            outside += fmt::format("{}{}", outside.empty() ? "" : ", ", band);
    return outside;
}

/// Beyond its measurements, a preset's absorption in excess of pure water's is constant. If that
/// excess is hardly visible over a metre of water, no warning is needed.
void warn_of_held_absorption(const WaterDesc& water, const JerlovPreset& preset,
                             std::vector<std::string>& warnings) {
    constexpr double k_visible = 0.02;  // of the light, per metre
    double most = 0;
    std::string outside;
    for (const double band : water.bands_nm) {
        if (preset.measured.contains(band)) continue;
        const double excess = preset.excess_absorption.value(band);
        const double absorbed = -std::expm1(-std::max(0.0, excess));
        if (absorbed < k_visible) continue;
        most = std::max(most, absorbed);
        outside += fmt::format("{}{:g}", outside.empty() ? "" : ", ", band);
    }
    if (outside.empty()) return;
    warnings.push_back(fmt::format(
        "{}: at {} nm the picture may be too dark or too bright by up to {:.2g} % per metre of "
        "water: {} was measured from {} to {} nm, and its last value is taken beyond",
        water.where, outside, 100 * most, preset.name, preset.measured.first_nm,
        preset.measured.last_nm));
}

}  // namespace

Spectrum uniform_absorption(const WaterDesc& water, const JerlovPreset* preset,
                            std::vector<std::string>& warnings) {
    Spectrum a{};
    if (water.absorption) {
        std::copy(water.absorption->begin(), water.absorption->end(), a.begin());
        if (water.cdom > 0 || water.chlorophyll > 0)
            warnings.push_back(
                fmt::format("{}: absorption is given, so cdom and chlorophyll are not used; remove "
                            "one or the other",
                            water.where));
        return a;
    }

    const WavelengthRange known = pure_water_absorption_range();
    if (const std::string outside = bands_outside(water, known); !outside.empty())
        throw InputError(
            fmt::format("{}: bands {} nm: the absorption of pure water is known from {} to {} nm; "
                        "choose bands within that range, or give the absorption",
                        water.where, outside, known.first_nm, known.last_nm));
    if (preset) warn_of_held_absorption(water, *preset, warnings);
    if (water.chlorophyll > 0) {
        const WavelengthRange range = chlorophyll_absorption_range();
        const std::string outside = bands_outside(water, range);
        if (!outside.empty())
            warnings.push_back(
                fmt::format("{}: bands {} nm: chlorophyll's absorption is known from {} to {} nm; "
                            "beyond that, its end value is held constant",
                            water.where, outside, range.first_nm, range.last_nm));
    }
    for (std::size_t i = 0; i < water.bands_nm.size(); ++i) {
        const double band = water.bands_nm[i];
        a[i] = preset ? jerlov_absorption(*preset, band, water.temperature, water.salinity)
                      : pure_water_absorption(band, water.temperature, water.salinity);
        a[i] += cdom_absorption(band, water.cdom);
        if (water.chlorophyll > 0) a[i] += chlorophyll_absorption(band, water.chlorophyll);
    }
    return a;
}

}  // namespace uw
