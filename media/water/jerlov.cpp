#include "media/water/jerlov.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "core/base/error.h"
#include "core/tables/csv_table.h"
#include "media/water/kopelevich.h"

namespace uw {

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

bool same_ignoring_case(std::string_view a, std::string_view b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](unsigned char x, unsigned char y) {
        return std::tolower(x) == std::tolower(y);
    });
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

}  // namespace uw
