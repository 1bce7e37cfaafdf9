#include "core/image/spectral_bands.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <numeric>

#include "core/base/csv_table.h"
#include "core/base/error.h"
#include "core/base/text.h"

namespace uw {

namespace {

/// Luminous efficacy of light at 555 nm, by which the SI defines the candela [lm/W].
constexpr double k_lumens_per_watt = 683;

}  // namespace

std::vector<BandInterval> band_intervals(std::span<const double> bands_nm) {
    const std::size_t count = bands_nm.size();
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::sort(order, {}, [&](std::size_t i) { return bands_nm[i]; });
    std::vector<BandInterval> intervals(count);
    for (std::size_t k = 0; k < count; ++k) {
        const double at = bands_nm[order[k]];
        const double below = k > 0 ? 0.5 * (at - bands_nm[order[k - 1]]) : 0;
        const double above = k + 1 < count ? 0.5 * (bands_nm[order[k + 1]] - at) : 0;
        intervals[order[k]] = {at - (k > 0 ? below : above), at + (k + 1 < count ? above : below)};
    }
    return intervals;
}

double mean_band_width(std::span<const BandInterval> intervals) {
    double sum = 0;
    for (const BandInterval& interval : intervals) sum += interval.width();
    return sum / static_cast<double>(intervals.size());
}

namespace {

constexpr double k_first_nm = 360;
constexpr double k_step_nm = 5;

// clang-format off
constexpr std::array<Xyz, 95> k_table{{
    {0.0001299, 3.917e-06, 0.0006061}, {0.0002321, 6.965e-06, 0.001086},
    {0.0004149, 1.239e-05, 0.001946}, {0.0007416, 2.202e-05, 0.003486},
    {0.001368, 3.9e-05, 0.006450001}, {0.002236, 6.4e-05, 0.01054999},
    {0.004243, 0.00012, 0.02005001}, {0.00765, 0.000217, 0.03621},
    {0.01431, 0.000396, 0.06785001}, {0.02319, 0.00064, 0.1102},
    {0.04351, 0.00121, 0.2074}, {0.07763, 0.00218, 0.3713},
    {0.13438, 0.004, 0.6456}, {0.21477, 0.0073, 1.0390501},
    {0.2839, 0.0116, 1.3856}, {0.3285, 0.01684, 1.62296},
    {0.34828, 0.023, 1.74706}, {0.34806, 0.0298, 1.7826},
    {0.3362, 0.038, 1.77211}, {0.3187, 0.048, 1.7441},
    {0.2908, 0.06, 1.6692}, {0.2511, 0.0739, 1.5281},
    {0.19536, 0.09098, 1.28764}, {0.1421, 0.1126, 1.0419},
    {0.09564, 0.13902, 0.8129501}, {0.05795001, 0.1693, 0.6162},
    {0.03201, 0.20802, 0.46518}, {0.0147, 0.2586, 0.3533},
    {0.0049, 0.323, 0.272}, {0.0024, 0.4073, 0.2123},
    {0.0093, 0.503, 0.1582}, {0.0291, 0.6082, 0.1117},
    {0.06327, 0.71, 0.07824999}, {0.1096, 0.7932, 0.05725001},
    {0.1655, 0.862, 0.04216}, {0.2257499, 0.9148501, 0.02984},
    {0.2904, 0.954, 0.0203}, {0.3597, 0.9803, 0.0134},
    {0.4334499, 0.9949501, 0.008749999}, {0.5120501, 1, 0.005749999},
    {0.5945, 0.995, 0.0039}, {0.6784, 0.9786, 0.002749999},
    {0.7621, 0.952, 0.0021}, {0.8425, 0.9154, 0.0018},
    {0.9163, 0.87, 0.001650001}, {0.9786, 0.8163, 0.0014},
    {1.0263, 0.757, 0.0011}, {1.0567, 0.6949, 0.001},
    {1.0622, 0.631, 0.0008}, {1.0456, 0.5668, 0.0006},
    {1.0026, 0.503, 0.00034}, {0.9384, 0.4412, 0.00024},
    {0.8544499, 0.381, 0.00019}, {0.7514, 0.321, 0.0001},
    {0.6424, 0.265, 4.999999e-05}, {0.5419, 0.217, 3e-05},
    {0.4479, 0.175, 2e-05}, {0.3608, 0.1382, 1e-05},
    {0.2835, 0.107, 0}, {0.2187, 0.0816, 0},
    {0.1649, 0.061, 0}, {0.1212, 0.04458, 0},
    {0.0874, 0.032, 0}, {0.0636, 0.0232, 0},
    {0.04677, 0.017, 0}, {0.0329, 0.01192, 0},
    {0.0227, 0.00821, 0}, {0.01584, 0.005723, 0},
    {0.01135916, 0.004102, 0}, {0.008110916, 0.002929, 0},
    {0.005790346, 0.002091, 0}, {0.004109457, 0.001484, 0},
    {0.002899327, 0.001047, 0}, {0.00204919, 0.00074, 0},
    {0.001439971, 0.00052, 0}, {0.0009999493, 0.0003611, 0},
    {0.0006900786, 0.0002492, 0}, {0.0004760213, 0.0001719, 0},
    {0.0003323011, 0.00012, 0}, {0.0002348261, 8.48e-05, 0},
    {0.0001661505, 6e-05, 0}, {0.000117413, 4.24e-05, 0},
    {8.307527e-05, 3e-05, 0}, {5.870652e-05, 2.12e-05, 0},
    {4.150994e-05, 1.499e-05, 0}, {2.935326e-05, 1.06e-05, 0},
    {2.067383e-05, 7.4657e-06, 0}, {1.455977e-05, 5.2578e-06, 0},
    {1.025398e-05, 3.7029e-06, 0}, {7.221456e-06, 2.6078e-06, 0},
    {5.085868e-06, 1.8366e-06, 0}, {3.581652e-06, 1.2934e-06, 0},
    {2.522525e-06, 9.1093e-07, 0}, {1.776509e-06, 6.4153e-07, 0},
    {1.251141e-06, 4.5181e-07, 0},
}};

// clang-format on

}  // namespace

Xyz cie1931_matching_functions(double wavelength_nm) {
    constexpr double k_last = static_cast<double>(k_table.size() - 1);
    const double at = (wavelength_nm - k_first_nm) / k_step_nm;
    if (!(at >= 0 && at <= k_last)) return {};
    const std::size_t i = std::min(static_cast<std::size_t>(at), k_table.size() - 2);
    const double t = at - static_cast<double>(i);
    const Xyz& a = k_table[i];
    const Xyz& b = k_table[i + 1];
    return {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), a.z + t * (b.z - a.z)};
}

Xyz mean_matching_functions(double begin_nm, double end_nm) {
    // Midpoint rule with a tenth of the table's step: accurate to 1e-4 of the peak, even across
    // kinks.
    const int steps =
        std::max(1, static_cast<int>(std::ceil(10 * (end_nm - begin_nm) / k_step_nm)));
    Xyz sum;
    for (int i = 0; i < steps; ++i) {
        const Xyz at =
            cie1931_matching_functions(begin_nm + (end_nm - begin_nm) * (i + 0.5) / steps);
        sum = {sum.x + at.x, sum.y + at.y, sum.z + at.z};
    }
    return {sum.x / steps, sum.y / steps, sum.z / steps};
}

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
