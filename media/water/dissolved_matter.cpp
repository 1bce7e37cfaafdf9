#include "media/water/dissolved_matter.h"

#include <cmath>

#include "core/tables/csv_table.h"

namespace uw {

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

}  // namespace uw
