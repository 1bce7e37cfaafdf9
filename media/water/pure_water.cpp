#include "media/water/pure_water.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/error.h"
#include "core/tables/csv_table.h"
#include "media/phase/molecular_phase.h"

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

}  // namespace uw
