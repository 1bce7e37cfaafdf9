#include "core/colour.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

#include "core/cie1931.h"

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

/// Width of the stretch of wavelengths that each band stands for, by the trapezoid rule [nm].
std::vector<double> trapezoid_widths(std::span<const double> bands_nm) {
    std::vector<std::size_t> order(bands_nm.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::sort(order, {}, [&](std::size_t i) { return bands_nm[i]; });
    std::vector<double> widths(bands_nm.size(), 0.0);
    for (std::size_t k = 1; k < order.size(); ++k) {
        const double half = 0.5 * (bands_nm[order[k]] - bands_nm[order[k - 1]]);
        widths[order[k - 1]] += half;
        widths[order[k]] += half;
    }
    return widths;
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

BandColour::BandColour(std::span<const double> bands_nm) : bands_(bands_nm.size()) {
    if (bands_ == 3) {
        for (std::size_t i = 0; i < 3; ++i) rgb_of_band_[i][i] = 1;
    } else if (bands_ == 1) {
        show_grey();
    } else {
        show_cie1931(bands_nm);
    }
}

void BandColour::show_grey() {
    for (std::size_t i = 0; i < bands_; ++i) rgb_of_band_[i].fill(1 / static_cast<double>(bands_));
}

void BandColour::show_cie1931(std::span<const double> bands_nm) {
    const std::vector<double> widths = trapezoid_widths(bands_nm);
    std::vector<std::array<double, 3>> xyz_of_band(bands_);
    std::array<double, 3> equal_energy{};
    for (std::size_t i = 0; i < bands_; ++i) {
        const Xyz response = cie1931_matching_functions(bands_nm[i]);
        xyz_of_band[i] = {widths[i] * response.x, widths[i] * response.y, widths[i] * response.z};
        for (std::size_t c = 0; c < 3; ++c) equal_energy[c] += xyz_of_band[i][c];
    }
    const double range = std::accumulate(widths.begin(), widths.end(), 0.0);
    if (!(*std::ranges::min_element(equal_energy) > k_blind * range)) {
        show_grey();
        warning_ =
            "water.bands: no colour can be made of these wavelengths; shown grey, the mean "
            "of the bands (add bands between 400 and 650 nm for colour)";
        return;
    }
    for (std::size_t i = 0; i < bands_; ++i) {
        for (std::size_t row = 0; row < 3; ++row) {
            for (std::size_t c = 0; c < 3; ++c) {
                rgb_of_band_[i][row] +=
                    k_rgb_from_xyz[row][c] * k_white_xyz[c] / equal_energy[c] * xyz_of_band[i][c];
            }
        }
    }
}

LinearRgb BandColour::operator()(const Spectrum& radiance) const {
    LinearRgb rgb{};
    for (std::size_t i = 0; i < bands_; ++i) {
        for (std::size_t c = 0; c < 3; ++c) rgb[c] += rgb_of_band_[i][c] * radiance[i];
    }
    return rgb;
}

}  // namespace uw
