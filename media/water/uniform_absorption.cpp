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
    if (preset) {
        const std::string outside = bands_outside(water, preset->measured);
        if (!outside.empty())
            warnings.push_back(
                fmt::format("{}: bands {} nm: {} was measured from {} to {} nm; beyond that, its "
                            "absorption in excess of pure water's is held constant",
                            water.where, outside, preset->name, preset->measured.first_nm,
                            preset->measured.last_nm));
    }
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
