#include "core/colour/colour_response.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/colour/lamp_spectrum.h"
#include "core/tables/csv_file.h"

namespace uw {

namespace {

constexpr std::array<std::string_view, 3> k_channels{"r", "g", "b"};
/// Fraction of a channel's greatest response below which it is considered blind.
constexpr double k_least_response = 1e-6;

// The light displayed as white, per band, with a mean of 1.
std::vector<double> white_of(const ColourDesc& desc, std::span<const double> bands_nm) {
    if (!desc.white) return std::vector<double>(bands_nm.size(), 1.0);
    if (bands_nm.size() < 2)
        throw InputError(fmt::format("{}: a single band has no colour to balance; remove it",
                                     desc.white->where));
    std::vector<double> white =
        band_values(make_lamp_spectrum(*desc.white), 1, band_intervals(bands_nm));
    double sum = 0;
    for (const double value : white) sum += value;
    if (!(sum > 0))
        throw InputError(fmt::format(
            "{}: has no light in any band of the scene; check its wavelengths and water.bands",
            desc.white->where));
    for (double& value : white) value *= static_cast<double>(white.size()) / sum;
    return white;
}

// The mean of `curve` over the band's interval; for a single band, the value itself.
double mean_response(const SampledCurve& curve, double band_nm, const BandInterval& interval) {
    if (interval.width() > 0)
        return integral(curve, interval.begin, interval.end) / interval.width();
    return curve.covers(band_nm) ? curve.value(band_nm) : 0;
}

BandColour camera_colour(const ColourDesc& desc, std::span<const double> bands_nm) {
    const CsvTable table = read_csv_file(desc.file, desc.where);
    const std::vector<BandInterval> intervals = band_intervals(bands_nm);
    const double mean_width = mean_band_width(intervals);
    const std::vector<double> white = white_of(desc, bands_nm);
    std::vector<LinearRgb> response(bands_nm.size());
    std::array<double, 3> of_equal{}, of_white{};
    for (std::size_t c = 0; c < 3; ++c) {
        const SampledCurve curve = table.curve("wavelength_nm", k_channels[c]);
        for (std::size_t i = 0; i < response.size(); ++i) {
            const double share = mean_width > 0 ? intervals[i].width() / mean_width : 1;
            response[i][c] = share * mean_response(curve, bands_nm[i], intervals[i]);
            of_equal[c] += response[i][c];
            of_white[c] += white[i] * response[i][c];
        }
        const double most = *std::ranges::max_element(curve.y);
        if (!(most > 0) || !(std::min(of_equal[c], of_white[c]) > k_least_response * most))
            throw InputError(fmt::format(
                "{}: the camera's {} does not respond to water.bands, or to the white light; "
                "check the table's wavelengths, or use another response",
                desc.where, k_channels[c]));
    }
    for (LinearRgb& band : response)
        for (std::size_t c = 0; c < 3; ++c)
            band[c] *= desc.raw ? 1 / of_equal[1] : of_white[1] / of_white[c] / of_equal[1];
    return BandColour(std::move(response));
}

}  // namespace

BandColour make_band_colour(const ColourDesc& desc, std::span<const double> bands_nm) {
    using Response = ColourDesc::Response;
    if (desc.response == Response::camera) return camera_colour(desc, bands_nm);
    const bool plain = !desc.white && !desc.raw;
    if (desc.response != Response::cie && plain) return BandColour(bands_nm);
    if (desc.raw) return {bands_nm, {}};
    return {bands_nm, white_of(desc, bands_nm)};
}

}  // namespace uw
