#pragma once

#include <vector>

#include "core/base/spectrum.h"
#include "core/colour/rgb.h"

namespace uw {

/// Converts the RGB reflectance of mesh files into one value per wavelength band.
///
/// Three bands are red, green and blue in this order, whatever their wavelengths. Any other number
/// of bands is interpolated linearly in wavelength between blue at 450 nm, green at 540 nm and red
/// at 620 nm, and held constant beyond these ends: RGB contains no more information.
class ReflectanceBands {
  public:
    /// `wavelengths_nm`: one per band, at most k_max_bands (else std::invalid_argument).
    explicit ReflectanceBands(const std::vector<double>& wavelengths_nm);

    int count() const { return static_cast<int>(weights_.size()); }
    /// Reflectance per band; entries past the band count are zero.
    Spectrum from_rgb(const Rgb& rgb) const;

  private:
    std::vector<Rgb> weights_;  // per band: the weights of R, G, B; they sum to 1
};

}  // namespace uw
