#include "core/colour/reflectance.h"

#include <algorithm>
#include <stdexcept>

namespace uw {
namespace {

constexpr double k_red_nm = 620, k_green_nm = 540, k_blue_nm = 450;

Rgb weights_at(double wavelength_nm) {
    const double nm = std::clamp(wavelength_nm, k_blue_nm, k_red_nm);
    if (nm <= k_green_nm) {
        const double green = (nm - k_blue_nm) / (k_green_nm - k_blue_nm);
        return {0, green, 1 - green};
    }
    const double red = (nm - k_green_nm) / (k_red_nm - k_green_nm);
    return {red, 1 - red, 0};
}

}  // namespace

ReflectanceBands::ReflectanceBands(const std::vector<double>& wavelengths_nm) {
    if (wavelengths_nm.empty() || wavelengths_nm.size() > k_max_bands) {
        throw std::invalid_argument("reflectance needs 1 to 32 bands");
    }
    if (wavelengths_nm.size() == 3) {
        weights_ = {Rgb{1, 0, 0}, Rgb{0, 1, 0}, Rgb{0, 0, 1}};
        return;
    }
    for (const double nm : wavelengths_nm) weights_.push_back(weights_at(nm));
}

Spectrum ReflectanceBands::from_rgb(const Rgb& rgb) const {
    Spectrum spectrum{};
    for (std::size_t band = 0; band < weights_.size(); ++band) {
        const Rgb& weight = weights_[band];
        spectrum[band] = weight[0] * rgb[0] + weight[1] * rgb[1] + weight[2] * rgb[2];
    }
    return spectrum;
}

}  // namespace uw
