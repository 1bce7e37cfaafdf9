#include "core/colour/lamp_spectrum.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/colour/cie1931.h"
#include "core/tables/csv_file.h"

namespace uw {

namespace {

constexpr double k_second_radiation_constant = 1.438776877e-2;  // c_2 [m K], CODATA 2018

LampSpectrum whole(SampledCurve curve) {
    LampSpectrum spectrum{std::move(curve), 0};
    spectrum.total = integral(spectrum.density, spectrum.density.first(), spectrum.density.last());
    return spectrum;
}

LampSpectrum blackbody(double temperature) {
    constexpr int k_lowest_nm = 100, k_highest_nm = 2000;            // beyond any band
    const double scale = k_second_radiation_constant / temperature;  // [m]
    // Planck's law over x = lambda T / c_2, up to a factor: x^-5 / (e^{1/x} - 1), integral pi^4/15.
    LampSpectrum spectrum;
    for (int nm = k_lowest_nm; nm <= k_highest_nm; ++nm) {
        const double x = nm * 1e-9 / scale;
        spectrum.density.x.push_back(nm);
        spectrum.density.y.push_back(std::pow(x, -5) / std::expm1(1 / x));
    }
    spectrum.total = std::pow(std::numbers::pi, 4) / 15 * scale * 1e9;
    return spectrum;
}

LampSpectrum led(const LampSpectrumDesc& desc) {
    const CsvTable table = read_embedded_table("cie_led_illuminants_5nm.csv");
    std::vector<std::string> names = table.columns();
    names.erase(names.begin());
    if (std::ranges::find(names, desc.name) == names.end())
        throw InputError(fmt::format("{}: no LED '{}'; the CIE's LEDs are {}", desc.where,
                                     printable(desc.name), fmt::join(names, ", ")));
    return whole(table.curve("wavelength_nm", desc.name));
}

// The column that the scene names, or the only one that is not the wavelength.
std::string column_of(const CsvTable& table, const LampSpectrumDesc& desc) {
    if (!desc.column.empty()) return desc.column;
    std::vector<std::string> others = table.columns();
    std::erase(others, "wavelength_nm");
    if (others.size() != 1)
        throw InputError(
            fmt::format("{}: {} has {} columns besides wavelength_nm; choose one with column: NAME",
                        desc.where, table.name(), others.size()));
    return others.front();
}

LampSpectrum from_file(const LampSpectrumDesc& desc) {
    const CsvTable table = read_csv_file(desc.file, desc.where);
    SampledCurve curve = table.curve("wavelength_nm", column_of(table, desc));
    if (curve.x.size() < 2 || *std::ranges::min_element(curve.y) < 0 ||
        *std::ranges::max_element(curve.y) <= 0)
        throw InputError(
            fmt::format("{}: {} is not a spectrum: it needs two or more rows, with values that are "
                        "not negative and not all 0",
                        desc.where, table.name()));
    if (curve.last() < 100 || curve.first() > 5000)
        throw InputError(fmt::format("{}: the wavelengths of {} go from {} to {}; give them in nm",
                                     desc.where, table.name(), curve.first(), curve.last()));
    return whole(std::move(curve));
}

double value_within(const SampledCurve& curve, double at) {
    return curve.covers(at) ? curve.value(at) : 0;
}

// The knots of either of two piecewise linear curves, 360 to 830 nm.
std::vector<double> knots_with_cie1931(const SampledCurve& curve) {
    std::vector<double> knots;
    for (int nm = 360; nm <= 830; nm += 5) knots.push_back(nm);
    for (const double x : curve.x)
        if (x > 360 && x < 830) knots.push_back(x);
    std::ranges::sort(knots);
    return knots;
}

}  // namespace

LampSpectrum make_lamp_spectrum(const LampSpectrumDesc& desc) {
    switch (desc.type) {
        case LampSpectrumDesc::Type::flat:
            return whole({{380, 780}, {1, 1}});
        case LampSpectrumDesc::Type::d65:
            return whole(read_embedded_table("cie_illuminant_d65_5nm.csv")
                             .curve("wavelength_nm", "relative_power"));
        case LampSpectrumDesc::Type::blackbody:
            return blackbody(desc.temperature);
        case LampSpectrumDesc::Type::led:
            return led(desc);
        case LampSpectrumDesc::Type::file:
            break;
    }
    return from_file(desc);
}

double integral(const SampledCurve& curve, double begin, double end) {
    const double from = std::max(begin, curve.first()), to = std::min(end, curve.last());
    if (!(from < to)) return 0;
    double sum = 0, at = from, value = curve.value(from);
    auto next = std::upper_bound(curve.x.begin(), curve.x.end(), from);
    while (at < to) {
        const double stop = next == curve.x.end() ? to : std::min(to, *next++);
        const double there = curve.value(stop);
        sum += 0.5 * (value + there) * (stop - at);
        at = stop;
        value = there;
    }
    return sum;
}

double luminous_efficacy(const LampSpectrum& spectrum) {
    const std::vector<double> knots = knots_with_cie1931(spectrum.density);
    const auto product = [&](double nm) {
        return cie1931_matching_functions(nm).y * value_within(spectrum.density, nm);
    };
    // Simpson's rule is exact for the product of two linear functions. A curve that begins or ends
    // with a value above 0 has a jump there: its ends are evaluated from inside.
    double sum = 0;
    constexpr double k_within = 1e-9;
    for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
        const double a = knots[i], b = knots[i + 1];
        sum += (b - a) / 6 *
               (product(a + k_within * (b - a)) + 4 * product(0.5 * (a + b)) +
                product(b - k_within * (b - a)));
    }
    return k_lumens_per_watt * sum / spectrum.total;
}

PerBand band_values(const LampSpectrum& spectrum, double total,
                    std::span<const BandInterval> intervals) {
    const double width = mean_band_width(intervals);
    PerBand values;
    for (const BandInterval& band : intervals)
        values.push_back(total * integral(spectrum.density, band.begin, band.end) / spectrum.total *
                         width / band.width());
    return values;
}

}  // namespace uw
