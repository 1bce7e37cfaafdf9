#include "core/optics/optical_depth.h"

#include "core/base/fast_exp.h"

namespace uw {

namespace {

Spectrum attenuation_of(const OpticalCoefficients& coefficients, int band_count) {
    Spectrum c{};
    for (int band = 0; band < band_count; ++band)
        c[static_cast<std::size_t>(band)] = coefficients.attenuation(band);
    return c;
}

}  // namespace

AttenuationTable::AttenuationTable(const Medium& medium)
    : uniform(attenuation_of(medium.uniform, medium.band_count())),
      band_count(medium.band_count()) {
    for (const Constituent& constituent : medium.constituents)
        constituents.push_back(attenuation_of(constituent.per_unit, band_count));
}

Spectrum AttenuationTable::transmittance(double length, std::span<const double> columns) const {
    Spectrum t{};
    for (int band = 0; band < band_count; ++band)
        t[static_cast<std::size_t>(band)] = exp_of_minus(optical_depth(band, length, columns));
    return t;
}

}  // namespace uw
