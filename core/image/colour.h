#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/base/spectrum.h"
#include "core/scene/render_desc.h"

namespace uw {

/// Linear sRGB (primaries of IEC 61966-2-1, scene-referred; values may be negative or above 1).
using LinearRgb = std::array<double, 3>;

/// Luminance of a linear sRGB value, relative to white (1, 1, 1).
double luminance(const LinearRgb& rgb);

/// The sRGB transfer function: linear 0..1 to encoded 0..1, clamped; 0 for NaN.
double srgb_encode(double linear);

/// srgb_encode to the nearest 8-bit value, 0 to 255, by table: [0, 1) in steps within which the
/// value changes once at most.
class SrgbBytes {
  public:
    SrgbBytes();
    std::uint8_t operator()(double linear) const {
        if (!(linear > 0)) return 0;
        if (linear >= 1) return 255;
        const Step& step = steps_[static_cast<std::size_t>(linear * k_steps)];
        return static_cast<std::uint8_t>(step.byte + (linear >= step.next ? 1 : 0));
    }

  private:
    // The steepest part is the straight one: 12.92 * 255 = 3295 values per unit.
    static constexpr int k_steps = 4096;
    struct Step {
        double next;  // the least value of the byte after this
        int byte;     // at the step's beginning
    };
    std::array<Step, k_steps> steps_{};
};
/// The table, made once.
const SrgbBytes& srgb_bytes();

/// Converts radiance per band into a colour. Linear, and a spectrum of 1 in all bands is white:
/// R = G = B = 1, Y = 1.
/// - Three bands are R, G and B themselves, unchanged.
/// - One band is grey.
/// - Any other number goes through CIE 1931: each band represents the wavelengths around it
///   (core/image/spectral_bands.h), over which its radiance is constant; X, Y and Z are each
///   scaled so that equal values in all bands are the white of sRGB (D65), then turned into linear
///   sRGB. Bands may come in any order. Colours outside the gamut have negative components, which
///   are kept. If the bands do not cover X, Y or Z (all in the infrared, say), there is no white to
///   balance: the image is then grey, the mean of the bands, and `warning` says so.
class BandColour {
  public:
    /// `bands_nm`: 1 to k_max_bands wavelengths.
    explicit BandColour(std::span<const double> bands_nm);

    /// CIE 1931 for any number of bands. `white`: the light displayed as white, per band; if empty,
    /// there is no white balance and X, Y and Z are those of the light itself. Y is normalised to
    /// equal values in all bands.
    BandColour(std::span<const double> bands_nm, std::span<const double> white);

    /// Uses another response: `response[i]` is the response of R, G and B to a radiance of 1 in
    /// band i.
    explicit BandColour(std::vector<LinearRgb> response) : bands_(response.size()), rgb_of_band_{} {
        std::copy(response.begin(), response.end(), rgb_of_band_.begin());
    }

    /// Reads the first `bands` values of `radiance`.
    LinearRgb operator()(const Spectrum& radiance) const;

    /// What some of the bands contribute to the colour: those of all parts of the bands add up.
    BandColour of(std::span<const std::size_t> bands) const;

    /// One line; empty if there is no warning.
    const std::string& warning() const { return warning_; }

  private:
    void show_grey();
    void show_cie1931(std::span<const double> bands_nm, std::span<const double> white);

    std::size_t bands_;
    std::array<LinearRgb, k_max_bands> rgb_of_band_{};
    std::string warning_;
};

/// The conversion from bands to R G B that the scene specifies: directly, by CIE 1931, or by a
/// camera's response curves, a table of wavelength_nm,r,g,b up to a factor, whose values are
/// responses to power. A camera's R, G and B stay in its own colour space: each is the mean
/// response over the bands' intervals, scaled such that equal values in all bands have G = 1 and
/// the white light has R = G = B. Throws InputError for an invalid table, for a channel without
/// response in any band, and for a white light that a channel does not see; IoError for a file that
/// cannot be read.
BandColour make_band_colour(const ColourDesc& desc, std::span<const double> bands_nm);

}  // namespace uw
