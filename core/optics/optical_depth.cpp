#include "core/optics/optical_depth.h"

#include "core/base/fast_exp.h"

namespace uw {

AttenuationTable::AttenuationTable(const Medium& medium)
    : uniform(medium.uniform.attenuation()), band_count(medium.band_count()) {
    for (const Constituent& constituent : medium.constituents)
        constituents.push_back(constituent.per_unit.attenuation());
}

Spectrum AttenuationTable::transmittance(double length, std::span<const double> columns) const {
    return per_band(static_cast<std::size_t>(band_count), [&](std::size_t band) {
        return exp_of_minus(optical_depth(band, length, columns));
    });
}

}  // namespace uw
