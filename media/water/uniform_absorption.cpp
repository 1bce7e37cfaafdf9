#include "media/water/uniform_absorption.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/error.h"
#include "media/water/dissolved_matter.h"
#include "media/water/pure_water.h"

namespace uw {

namespace {

/// The bands outside `range` as "620, 700", empty if there are none.
std::string bands_outside(const WaterDesc& water, const WavelengthRange& range) {
    std::string outside;
    for (const double band : water.bands_nm)
        if (!range.contains(band))
            outside += fmt::format("{}{}", outside.empty() ? "" : ", ", band);
    return outside;
}

/// Beyond its measurements, a preset's absorption in excess of pure water's is held. If all of that
/// hardly shows over a metre of water, there is nothing to say.
void warn_of_held_absorption(const WaterDesc& water, const JerlovPreset& preset,
                             std::vector<std::string>& warnings) {
    constexpr double k_visible = 0.02;  // of the light, per metre
    double most = 0;
    std::string outside;
    for (const double band : water.bands_nm) {
        if (preset.measured.contains(band)) continue;
        const double held = preset.excess_absorption.value(band);
        const double share = -std::expm1(-std::max(0.0, held));
        if (share < k_visible) continue;
        most = std::max(most, share);
        outside += fmt::format("{}{:g}", outside.empty() ? "" : ", ", band);
    }
    if (outside.empty()) return;
    warnings.push_back(fmt::format(
        "{}: at {} nm the picture may be too dark or too bright by up to {:.2g} % per metre of "
        "water: {} was measured from {} to {} nm, and its last value is taken beyond",
        water.where, outside, 100 * most, preset.name, preset.measured.first_nm,
        preset.measured.last_nm));
}

}  // namespace

Spectrum uniform_absorption(const WaterDesc& water, const JerlovPreset* preset,
                            std::vector<std::string>& warnings) {
    Spectrum a{};
    if (water.absorption) {
        std::copy(water.absorption->begin(), water.absorption->end(), a.begin());
        if (water.cdom > 0 || water.chlorophyll > 0)
            warnings.push_back(
                fmt::format("{}: absorption is given, so cdom and chlorophyll are not used; remove "
                            "one or the other",
                            water.where));
        return a;
    }

    const WavelengthRange known = pure_water_absorption_range();
    if (const std::string outside = bands_outside(water, known); !outside.empty())
        throw InputError(
            fmt::format("{}: bands {} nm: the absorption of pure water is known from {} to {} nm; "
                        "choose bands within that range, or give the absorption",
                        water.where, outside, known.first_nm, known.last_nm));
    if (preset) warn_of_held_absorption(water, *preset, warnings);
    if (water.chlorophyll > 0) {
        const WavelengthRange range = chlorophyll_absorption_range();
        const std::string outside = bands_outside(water, range);
        if (!outside.empty())
            warnings.push_back(
                fmt::format("{}: bands {} nm: chlorophyll's absorption is known from {} to {} nm; "
                            "beyond that, its end value is held constant",
                            water.where, outside, range.first_nm, range.last_nm));
    }
    for (std::size_t i = 0; i < water.bands_nm.size(); ++i) {
        const double band = water.bands_nm[i];
        a[i] = preset ? jerlov_absorption(*preset, band, water.temperature, water.salinity)
                      : pure_water_absorption(band, water.temperature, water.salinity);
        a[i] += cdom_absorption(band, water.cdom);
        if (water.chlorophyll > 0) a[i] += chlorophyll_absorption(band, water.chlorophyll);
    }
    return a;
}

}  // namespace uw
