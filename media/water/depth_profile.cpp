#include "media/water/depth_profile.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>

#include "core/base/csv_table.h"
#include "core/base/error.h"
#include "media/water/species.h"
#include "media/water/water_types.h"

namespace uw {

namespace {

constexpr std::string_view k_depth = "depth_m";
constexpr double k_max_depth = 1e4, k_max_value = 1e12;

/// The table's columns by name; every one of them has to be taken.
class ProfileColumns {
  public:
    ProfileColumns(const WaterDesc& water, const CsvTable& table)
        : water_(water), table_(table), is_taken_(table.columns().size(), false) {}

    [[noreturn]] void fail(std::string_view what) const {
        throw InputError(fmt::format("{}: {}: {}", water_.profile->where, table_.name(), what));
    }

    bool has(std::string_view name) const {
        return std::ranges::find(table_.columns(), name) != table_.columns().end();
    }

    /// The values >= 0 of a column that the table has.
    std::vector<double> take(std::string_view name) {
        const auto at = std::ranges::find(table_.columns(), name) - table_.columns().begin();
        is_taken_[static_cast<std::size_t>(at)] = true;
        std::vector<double> values = table_.numbers(name);
        for (const double value : values)
            if (!(value >= 0 && value <= k_max_value))
                fail(fmt::format("column {} has the value {:g}; give 0 or more", name, value));
        return values;
    }

    /// A coefficient per depth and band, of "NAME", which holds for all bands, or of "NAME_620" for
    /// each of them; empty if the table has neither.
    std::vector<double> take_per_band(std::string_view name) {
        const std::size_t bands = water_.bands_nm.size();
        std::vector<double> values;
        const auto set = [&](std::size_t band, const std::vector<double>& column) {
            values.resize(column.size() * bands);
            for (std::size_t i = 0; i < column.size(); ++i) values[i * bands + band] = column[i];
        };
        if (has(name)) {
            const std::vector<double> column = take(name);
            for (std::size_t band = 0; band < bands; ++band) set(band, column);
            return values;
        }
        for (std::size_t band = 0; band < bands; ++band) {
            const std::string of_band = fmt::format("{}_{:g}", name, water_.bands_nm[band]);
            if (has(of_band))
                set(band, take(of_band));
            else if (std::ranges::any_of(table_.columns(), [&](const std::string& column) {
                         return column.starts_with(std::string(name) + "_");
                     }))
                fail(
                    fmt::format("has no column {}; name one for each of the water's bands, or "
                                "{} for all of them",
                                of_band, name));
        }
        return values;
    }

    /// The columns of species: a name, perhaps with a unit after a blank.
    std::vector<DepthProfile::OfSpecies> take_species() {
        std::vector<DepthProfile::OfSpecies> all;
        for (std::size_t i = 0; i < water_.species.size(); ++i) {
            const SpeciesDesc& species = water_.species[i];
            for (const std::string& column : table_.columns()) {
                const bool is_its =
                    column == species.name || column.starts_with(species.name + " ");
                if (!is_its) continue;
                if (!all.empty() && all.back().species == i)
                    fail(fmt::format("has two columns of {}; remove one", species.name));
                const SpeciesAmount one =
                    read_amount("1" + column.substr(species.name.size()), i, species,
                                fmt::format("{}: {}: column {}", water_.profile->where,
                                            table_.name(), quoted_cell(column)));
                const double unit = concentration_of(species, one, water_);
                DepthProfile::OfSpecies of{i, take(column)};
                for (double& value : of.concentration) value *= unit;
                all.push_back(std::move(of));
            }
        }
        return all;
    }

    void finish() const {
        for (std::size_t i = 0; i < is_taken_.size(); ++i)
            if (!is_taken_[i])
                fail(fmt::format(
                    "unknown column {}; columns are depth_m, chlorophyll, cdom, absorption, "
                    "scattering, attenuation (or absorption_620 by band), small, large and the "
                    "names of water.species",
                    quoted_cell(table_.columns()[i])));
        if (is_taken_.size() < 2) fail("has no column but depth_m; add one, such as chlorophyll");
    }

  private:
    const WaterDesc& water_;
    const CsvTable& table_;
    std::vector<bool> is_taken_;
};

void refuse(bool is_given, const ProfileColumns& columns, std::string_view column,
            std::string_view key) {
    if (is_given)
        columns.fail(fmt::format("has {}, in whose place the water has {}; remove one of them",
                                 column, key));
}

std::vector<double> difference(const ProfileColumns& columns, const std::vector<double>& whole,
                               const std::vector<double>& part) {
    std::vector<double> rest;
    for (std::size_t i = 0; i < whole.size(); ++i) {
        rest.push_back(whole[i] - part[i]);
        // Tolerates the rounding of the table's digits.
        if (rest.back() < -1e-9 * whole[i])
            columns.fail("an attenuation is less than what it consists of; mend the table");
        rest.back() = std::max(0.0, rest.back());
    }
    return rest;
}

/// Absorption and scattering as the table gives them.
void read_coefficients(const WaterDesc& water, ProfileColumns& columns, DepthProfile& profile) {
    profile.absorption = columns.take_per_band("absorption");
    profile.scattering = columns.take_per_band("scattering");
    const std::vector<double> attenuation = columns.take_per_band("attenuation");
    if (!attenuation.empty()) {
        if (profile.absorption.empty() == profile.scattering.empty())
            columns.fail(
                "attenuation needs one of absorption and scattering beside it, which is taken "
                "from it");
        (profile.absorption.empty() ? profile.absorption : profile.scattering) =
            difference(columns, attenuation,
                       profile.absorption.empty() ? profile.scattering : profile.absorption);
    }
    if (!profile.absorption.empty()) {
        refuse(water.absorption.has_value(), columns, "absorption", "absorption");
        refuse(!water.preset.empty(), columns, "absorption", "preset");
        refuse(water.cdom > 0, columns, "absorption", "cdom");
        refuse(water.chlorophyll > 0, columns, "absorption", "chlorophyll");
    }
    const bool is_by_depth = water.scattering && water.scattering->is_by_depth;
    if (!profile.scattering.empty() && !is_by_depth)
        columns.fail(
            "has scattering, whose phase function is missing; add scattering: {phase: {type: hg, "
            "g: 0.9}} to the water, without b");
    if (profile.scattering.empty() && is_by_depth)
        columns.fail("has no column scattering; add it, or b to the water's scattering");
}

/// Absorption by dissolved matter and phytoplankton, which is not linear in the chlorophyll, at
/// each depth.
void read_dissolved(const WaterDesc& water, ProfileColumns& columns, DepthProfile& profile) {
    const bool has_chlorophyll = columns.has("chlorophyll"), has_cdom = columns.has("cdom");
    if (!has_chlorophyll && !has_cdom) return;
    const std::string_view name = has_chlorophyll ? "chlorophyll" : "cdom";
    if (!profile.absorption.empty())
        columns.fail(fmt::format("has absorption, which holds {} already; remove one", name));
    refuse(water.absorption.has_value(), columns, name, "absorption");
    refuse(!water.preset.empty(), columns, name, "preset");
    refuse(has_chlorophyll && water.chlorophyll > 0, columns, "chlorophyll", "chlorophyll");
    refuse(has_cdom && water.cdom > 0, columns, "cdom", "cdom");
    const std::vector<double> chlorophyll =
        has_chlorophyll ? columns.take("chlorophyll") : std::vector<double>();
    const std::vector<double> cdom = has_cdom ? columns.take("cdom") : std::vector<double>();
    for (std::size_t i = 0; i < profile.depths.size(); ++i) {
        WaterDesc here = water;
        if (has_chlorophyll) here.chlorophyll = chlorophyll[i];
        if (has_cdom) here.cdom = cdom[i];
        std::vector<std::string> warnings;
        const Spectrum a = uniform_absorption(here, nullptr, warnings);
        for (std::string& warning : warnings)
            if (std::ranges::find(profile.warnings, warning) == profile.warnings.end())
                profile.warnings.push_back(std::move(warning));
        profile.absorption.insert(profile.absorption.end(), a.begin(),
                                  a.begin() + static_cast<std::ptrdiff_t>(water.bands_nm.size()));
    }
}

void read_particles(const WaterDesc& water, ProfileColumns& columns, DepthProfile& profile) {
    const auto take_kopelevich = [&](const char* name, bool is_given, std::vector<double>& values) {
        if (!columns.has(name)) return;
        refuse(is_given, columns, name, fmt::format("particles.{}", name));
        if (water.mineral_absorption && !water.preset.empty())
            columns.fail(
                fmt::format("has {}, of which a preset's absorption holds an unknown part; "
                            "remove particles.absorption, or the preset",
                            name));
        values = columns.take(name);
    };
    take_kopelevich("small", water.small_ppm.has_value(), profile.small);
    take_kopelevich("large", water.large_ppm.has_value(), profile.large);
    profile.species = columns.take_species();
    for (const DepthProfile::OfSpecies& of : profile.species)
        for (const SpeciesAmount& amount : water.amounts)
            refuse(amount.species == of.species, columns, water.species[of.species].name,
                   "particles." + water.species[of.species].name);
    if (water.scattering &&
        !(profile.small.empty() && profile.large.empty() && profile.species.empty()))
        columns.fail("has particles, in whose place the water has scattering; remove one of them");
}

}  // namespace

DepthProfile read_depth_profile(const WaterDesc& water) {
    const CsvTable table = read_csv_file(water.profile->file, water.profile->where);
    ProfileColumns columns(water, table);
    if (!columns.has(k_depth)) columns.fail("has no column depth_m; give depths below the surface");
    DepthProfile profile;
    profile.depths = columns.take(k_depth);
    if (profile.depths.empty()) columns.fail("has no rows; give at least one depth");
    for (std::size_t i = 0; i < profile.depths.size(); ++i) {
        if (!(profile.depths[i] <= k_max_depth))
            columns.fail(
                fmt::format("the depth {:g} m is beyond {:g} m", profile.depths[i], k_max_depth));
        if (i > 0 && !(profile.depths[i] > profile.depths[i - 1]))
            columns.fail(fmt::format("depths do not ascend: {:g} m follows {:g} m; sort the rows",
                                     profile.depths[i], profile.depths[i - 1]));
    }
    read_coefficients(water, columns, profile);
    read_dissolved(water, columns, profile);
    read_particles(water, columns, profile);
    columns.finish();
    return profile;
}

bool profile_is_per_band(const WaterDesc& water) {
    if (!water.profile) return false;
    const CsvTable table = read_csv_file(water.profile->file, water.profile->where);
    return std::ranges::any_of(table.columns(), [](const std::string& column) {
        return column.starts_with("absorption_") || column.starts_with("scattering_") ||
               column.starts_with("attenuation_");
    });
}

}  // namespace uw
