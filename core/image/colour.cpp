#include "core/image/colour.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/csv_table.h"
#include "core/base/error.h"
#include "core/image/spectral_bands.h"

namespace uw {

namespace {

using Matrix = std::array<std::array<double, 3>, 3>;

// Linear sRGB and XYZ (D65, Y = 1), derived from the primaries R (.64, .33), G (.30, .60),
// B (.15, .06) and the white (.3127, .3290) of IEC 61966-2-1.
constexpr Matrix k_rgb_from_xyz{{{3.2409699419, -1.5373831776, -0.4986107603},
                                 {-0.9692436363, 1.8759675015, 0.0415550574},
                                 {0.0556300797, -0.2039769589, 1.0569715142}}};
constexpr std::array<double, 3> k_luminance_of_rgb{0.2126390059, 0.7151686788, 0.0721923154};
constexpr std::array<double, 3> k_white_xyz{0.3127 / 0.3290, 1, (1 - 0.3127 - 0.3290) / 0.3290};

/// Mean response below which a band set is blind to X, Y or Z; the functions peak at 1.06 to 1.78.
constexpr double k_blind = 1e-6;

/// The response of X, Y and Z to a radiance of 1 in each band: the matching functions' means over
/// the bands' intervals, times their widths relative to the mean width; all zero if the mean width
/// is zero.
std::vector<std::array<double, 3>> tristimulus_of_bands(std::span<const double> bands_nm) {
    const std::vector<BandInterval> intervals = band_intervals(bands_nm);
    const double mean_width = mean_band_width(intervals);
    std::vector<std::array<double, 3>> xyz(bands_nm.size());
    if (!(mean_width > 0)) return xyz;
    for (std::size_t i = 0; i < xyz.size(); ++i) {
        const Xyz mean = mean_matching_functions(intervals[i].begin, intervals[i].end);
        const double ratio = intervals[i].width() / mean_width;
        xyz[i] = {ratio * mean.x, ratio * mean.y, ratio * mean.z};
    }
    return xyz;
}

/// The least value that srgb_encode brings to this byte or above, by bisection; 1 if there is none.
double min_of_byte(int byte) {
    double below = 0, above = 1;
    for (;;) {
        const double middle = 0.5 * (below + above);
        if (middle <= below || middle >= above) return above;
        (std::lround(255 * srgb_encode(middle)) < byte ? below : above) = middle;
    }
}

}  // namespace

double luminance(const LinearRgb& rgb) {
    return std::inner_product(rgb.begin(), rgb.end(), k_luminance_of_rgb.begin(), 0.0);
}

double srgb_encode(double linear) {
    if (!(linear > 0)) return 0;
    if (linear >= 1) return 1;
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

SrgbBytes::SrgbBytes() {
    int byte = 0;
    double next = min_of_byte(1);
    for (int i = 0; i < k_steps; ++i) {
        while (static_cast<double>(i) / k_steps >= next) next = min_of_byte(++byte + 1);
        steps_[static_cast<std::size_t>(i)] = {next, byte};
    }
}

const SrgbBytes& srgb_bytes() {
    static const SrgbBytes bytes;
    return bytes;
}

BandColour::BandColour(std::span<const double> bands_nm) : bands_(bands_nm.size()) {
    if (bands_ == 3) {
        for (std::size_t i = 0; i < 3; ++i) rgb_of_band_[i][i] = 1;
    } else if (bands_ == 1) {
        show_grey();
    } else {
        show_cie1931(bands_nm, std::vector<double>(bands_, 1.0));
    }
}

BandColour::BandColour(std::span<const double> bands_nm, std::span<const double> white)
    : bands_(bands_nm.size()) {
    show_cie1931(bands_nm, white);
}

void BandColour::show_grey() {
    for (std::size_t i = 0; i < bands_; ++i) rgb_of_band_[i].fill(1 / static_cast<double>(bands_));
}

void BandColour::show_cie1931(std::span<const double> bands_nm, std::span<const double> white) {
    const std::vector<std::array<double, 3>> xyz_of_band = tristimulus_of_bands(bands_nm);
    std::array<double, 3> equal_values{}, white_values{};
    for (std::size_t i = 0; i < bands_; ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
            equal_values[c] += xyz_of_band[i][c];
            if (!white.empty()) white_values[c] += white[i] * xyz_of_band[i][c];
        }
    }
    const std::array<double, 3>& seen = white.empty() ? equal_values : white_values;
    if (!(*std::ranges::min_element(seen) > k_blind * static_cast<double>(bands_))) {
        show_grey();
        warning_ =
            "water.bands: these wavelengths do not define a colour; the image is shown in grey, as "
            "the mean of the bands (add bands between 400 and 650 nm for colour)";
        return;
    }
    for (std::size_t c = 0; c < 3; ++c) {
        // Equal values have Y = 1, whatever the white.
        const double scale =
            white.empty() ? 1 / equal_values[1]
                          : k_white_xyz[c] * white_values[1] / white_values[c] / equal_values[1];
        for (std::size_t i = 0; i < bands_; ++i)
            for (std::size_t row = 0; row < 3; ++row)
                rgb_of_band_[i][row] += k_rgb_from_xyz[row][c] * scale * xyz_of_band[i][c];
    }
}

BandColour BandColour::of(std::span<const std::size_t> bands) const {
    BandColour part = *this;
    part.rgb_of_band_ = {};
    for (const std::size_t band : bands) part.rgb_of_band_[band] = rgb_of_band_[band];
    return part;
}

LinearRgb BandColour::operator()(const Spectrum& radiance) const {
    LinearRgb rgb{};
    for (std::size_t i = 0; i < bands_; ++i) {
        for (std::size_t c = 0; c < 3; ++c) rgb[c] += rgb_of_band_[i][c] * radiance[i];
    }
    return rgb;
}

namespace {

constexpr std::array<std::string_view, 3> k_channels{"r", "g", "b"};
/// Fraction of a channel's greatest response below which it is considered blind.
constexpr double k_min_response = 1e-6;

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
            const double ratio = mean_width > 0 ? intervals[i].width() / mean_width : 1;
            response[i][c] = ratio * mean_response(curve, bands_nm[i], intervals[i]);
            of_equal[c] += response[i][c];
            of_white[c] += white[i] * response[i][c];
        }
        const double most = *std::ranges::max_element(curve.y);
        if (!(most > 0) || !(std::min(of_equal[c], of_white[c]) > k_min_response * most))
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
