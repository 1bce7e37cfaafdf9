#include "media/inspection/water_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/base/numerics.h"
#include "media/water/depth_profile.h"
#include "media/water/molecular_phase.h"
#include "media/water/species.h"
#include "media/water/tabulated_phase.h"
#include "media/water/water_model.h"
#include "media/water/water_types.h"

namespace uw {

namespace {

constexpr double k_pi = std::numbers::pi;

/// 2 pi int p f sin over [from, pi]: Gauss-Legendre on panels between the phase function's
/// breakpoints, each cut into 32.
template <class F>
double moment(const PhaseFunction& phase, double from, F f) {
    constexpr int k_panels = 32;
    std::vector<double> edges{from};
    for (const double at : phase.breakpoints())
        if (at > from) edges.push_back(at);
    edges.push_back(k_pi);
    double sum = 0;
    for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
        const double width = (edges[i + 1] - edges[i]) / k_panels;
        for (int panel = 0; panel < k_panels; ++panel)
            for (const QuadratureNode& node : gauss_legendre(4)) {
                const double psi = edges[i] + width * (panel + node.position);
                sum += node.weight * width * phase.eval(psi) * f(psi) * std::sin(psi);
            }
    }
    return 2 * k_pi * sum;
}

/// The names used in figure 4 of the paper for its own components.
std::string part_name(const PhaseFunction& phase) {
    if (dynamic_cast<const MolecularPhase*>(&phase)) return "water";
    if (dynamic_cast<const KopelevichSmall*>(&phase)) return "small";
    if (dynamic_cast<const KopelevichLarge*>(&phase)) return "large";
    return phase.description();
}

MeasuredPhase measured(const std::shared_ptr<const PhaseFunction>& phase) {
    return {phase, backscatter_fraction(*phase), mean_cosine(*phase)};
}

/// Appends the first `count` bands of `x` to `table`.
void append(const OpticalCoefficients& x, const Medium& medium, CoefficientTable& table) {
    const auto count = static_cast<std::size_t>(medium.band_count());
    const std::size_t known = table.absorption.size();
    table.absorption.insert(table.absorption.end(), x.absorption.begin(),
                            x.absorption.begin() + medium.band_count());
    for (std::size_t m = 0; m < medium.phase_functions.size(); ++m) {
        const Spectrum& b = x.scattering[m];
        if (std::all_of(b.begin(), b.end(), [](double value) { return value == 0; })) continue;
        const std::shared_ptr<const PhaseFunction>& phase = medium.phase_functions[m];
        const std::string name = part_name(*phase);
        const bool is_by_band = dynamic_cast<const SpeciesPhase*>(phase.get()) != nullptr;
        auto part =
            std::find_if(table.parts.begin(), table.parts.end(), [&](const ScatteringPart& other) {
                // Within one medium the phase functions of two parts differ, even if their
                // descriptions do not.
                return other.name == name && (is_by_band || other.b.size() <= known);
            });
        if (part == table.parts.end()) {
            table.parts.push_back({name, {}, std::vector<double>(known, 0.0)});
            part = table.parts.end() - 1;
            if (!is_by_band) part->phases = {measured(phase)};
        }
        part->b.resize(known + count);
        if (is_by_band) part->phases.resize(known + count);
        for (std::size_t i = 0; i < count; ++i) {
            part->b[known + i] += b[i];
            if (is_by_band && b[i] > 0) part->phases[known + i] = measured(phase);
        }
    }
}

double ratio(double a, double b) {
    return b > 0 ? a / b : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

double backscatter_fraction(const PhaseFunction& phase) {
    return moment(phase, k_pi / 2, [](double) { return 1.0; });
}

double mean_cosine(const PhaseFunction& phase) {
    // For symmetric scattering the remainder is only rounding, and is taken as 0.
    constexpr double k_rounding = 1e-13;
    const double mean = moment(phase, 0, [](double psi) { return std::cos(psi); });
    return std::abs(mean) < k_rounding ? 0 : mean;
}

double CoefficientTable::scattering(std::size_t i) const {
    double b = 0;
    for (const ScatteringPart& part : parts) b += part.b[i];
    return b;
}

double CoefficientTable::attenuation(std::size_t i) const {
    return absorption[i] + scattering(i);
}

double CoefficientTable::backscattering(std::size_t i) const {
    double b = 0;
    for (const ScatteringPart& part : parts) b += part.b[i] * part.at(i).backscatter_fraction;
    return b;
}

double CoefficientTable::backscatter_fraction(std::size_t i) const {
    return ratio(backscattering(i), scattering(i));
}

double CoefficientTable::mean_cosine(std::size_t i) const {
    double sum = 0;
    for (const ScatteringPart& part : parts) sum += part.b[i] * part.at(i).mean_cosine;
    return ratio(sum, scattering(i));
}

double CoefficientTable::albedo(std::size_t i) const {
    return ratio(scattering(i), attenuation(i));
}

double CoefficientTable::vsf(std::size_t i, std::size_t part, double psi) const {
    const double b = parts[part].b[i];
    return b > 0 ? b * parts[part].at(i).phase->eval(psi) : 0;
}

double CoefficientTable::vsf(std::size_t i, double psi) const {
    double beta = 0;
    for (std::size_t part = 0; part < parts.size(); ++part) beta += vsf(i, part, psi);
    return beta;
}

bool is_given_per_band(const WaterDesc& water, const std::vector<VolumeDesc>& volumes) {
    if (water.absorption || water.scattering || profile_is_per_band(water)) return true;
    return std::any_of(volumes.begin(), volumes.end(), [](const VolumeDesc& volume) {
        return std::any_of(volume.grids.begin(), volume.grids.end(),
                           [](const GridMappingDesc& grid) { return grid.optics.has_value(); });
    });
}

namespace {

/// A volume with all of the water's species, so that there is a table of each.
VolumeDesc volume_of_species(const WaterDesc& water) {
    VolumeDesc volume;
    GridMappingDesc& grid = volume.grids.emplace_back();
    for (std::size_t i = 0; i < water.species.size(); ++i)
        grid.amounts.push_back({i, 1, SpeciesAmount::Unit::own});
    return volume;
}

double grams_per_unit(const WaterDesc& water, const Constituent& constituent) {
    for (const SpeciesDesc& species : all_species(water)) {
        if (species.name != constituent.name || unit_of(species) != constituent.unit) continue;
        if (species.density) return *species.density;
        const bool is_weighed = species.vsf && species.vsf->sample &&
                                species.vsf->sample->unit == SpeciesAmount::Unit::grams;
        return is_weighed ? species.vsf->sample->amount : 0;
    }
    return 0;
}

void append_depths(const WaterModel& model, WaterTable& table) {
    if (!model.strata) return;
    table.depths = model.strata->depths();
    table.absorption_at.resize(table.depths.size());
    table.scattering_at.resize(table.depths.size());
    const std::vector<OpticalCoefficients> all = coefficients_by_depth(model);
    for (std::size_t i = 0; i < all.size(); ++i) {
        const Spectrum a = all[i].absorption, b = all[i].total_scattering();
        for (std::size_t band = 0; band < model.medium.wavelengths_nm.size(); ++band) {
            table.absorption_at[i].push_back(a[band]);
            table.scattering_at[i].push_back(b[band]);
        }
    }
}

}  // namespace

WaterTable tabulate_water(const WaterDesc& water, const std::vector<VolumeDesc>& volumes_of_scene,
                          const ProgressCallback& progress) {
    WaterTable table;
    std::vector<VolumeDesc> volumes = volumes_of_scene;
    if (!water.species.empty()) volumes.push_back(volume_of_species(water));
    table.wavelengths_nm = water.bands_nm;
    const auto most = is_given_per_band(water, volumes)
                          ? std::max<std::size_t>(1, water.bands_nm.size())
                          : static_cast<std::size_t>(k_max_bands);
    // At least one iteration, so that water without bands is rejected as everywhere else.
    for (std::size_t first = 0; first == 0 || first < water.bands_nm.size(); first += most) {
        WaterDesc piece = water;
        const std::size_t last = std::min(first + most, water.bands_nm.size());
        piece.bands_nm.assign(water.bands_nm.begin() + static_cast<std::ptrdiff_t>(first),
                              water.bands_nm.begin() + static_cast<std::ptrdiff_t>(last));
        ProgressCallback of_piece;
        if (progress)
            of_piece = [&](double fraction) {
                const auto all = static_cast<double>(water.bands_nm.size());
                progress(
                    (static_cast<double>(first) + fraction * static_cast<double>(last - first)) /
                    all);
            };
        const WaterModel model = build_water_model(piece, volumes, of_piece);
        append(model.medium.uniform, model.medium, table.uniform);
        std::size_t k = 0;
        for (const Constituent& constituent : model.medium.constituents) {
            // Coefficients that change with depth are not those of a concentration.
            if (constituent.unit == "1/m") continue;
            if (k == table.constituents.size())
                table.constituents.push_back({constituent.name,
                                              constituent.unit,
                                              grams_per_unit(water, constituent),
                                              {},
                                              {}});
            append(constituent.per_unit, model.medium, table.constituents[k++]);
        }
        append_depths(model, table);
        table.small_ppm = model.small_ppm;
        table.large_ppm = model.large_ppm;
        for (const std::string& warning : model.warnings)
            if (std::find(table.warnings.begin(), table.warnings.end(), warning) ==
                table.warnings.end())
                table.warnings.push_back(warning);
    }
    return table;
}

namespace {

std::string absorption_source(const WaterDesc& water, double small_ppm, double large_ppm) {
    std::string text;
    const std::string state =
        fmt::format("{:g} deg C, {:g} PSU", water.temperature, water.salinity);
    if (water.absorption) {
        text = "absorption: as given per band";
    } else if (!water.preset.empty()) {
        const JerlovPreset& preset = jerlov_preset(water.preset);
        text = fmt::format(
            "absorption: {} as measured from {:g} to {:g} nm (Williamson and Hollins 2022); its "
            "excess over pure water's (WOPP v3, Roettgers et al. 2016; {}) is interpolated, and "
            "held beyond",
            preset.name, preset.measured.first_nm, preset.measured.last_nm, state);
    } else {
        text = fmt::format("absorption: pure water, WOPP v3 (Roettgers et al. 2016), {}", state);
    }
    if (!water.absorption && water.cdom > 0)
        text += fmt::format(
            "; dissolved matter {:g} 1/m at 440 nm, exp(-0.014 (nm - 440)) "
            "(Bricaud et al. 1981)",
            water.cdom);
    if (!water.absorption && water.chlorophyll > 0)
        text += fmt::format("; chlorophyll {:g} mg/m^3 (Bricaud et al. 1995)", water.chlorophyll);
    const bool has_kopelevich =
        small_ppm + large_ppm > 0 || std::ranges::any_of(water.amounts, [&](const auto& amount) {
            return water.species[amount.species].kopelevich.has_value();
        });
    if (water.mineral_absorption && has_kopelevich)
        text += water.absorption || water.preset.empty()
                    ? "; particles as mineral (Babin et al. 2003)"
                    : "; particles beyond the preset's own as mineral (Babin et al. 2003)";
    return text;
}

std::string amount_source(const WaterDesc& water, const SpeciesAmount& amount) {
    const SpeciesDesc& species = water.species[amount.species];
    const double concentration = concentration_of(species, amount, water);
    if (!species.vsf)
        return fmt::format("{:.4g} ppm {}, {}", concentration, species.name,
                           species.kopelevich ? "Kopelevich 1983" : "Lorenz-Mie");
    return fmt::format("{:.4g} times the sample of {}, {}", concentration, species.name,
                       species.vsf->library.empty() ? "as measured" : "Petzold 1972");
}

std::string scattering_source(const WaterDesc& water, double small_ppm, double large_ppm) {
    if (water.scattering) return "scattering: as given per band, with one phase function";
    std::string text =
        fmt::format("scattering: water's molecules, Einstein-Smoluchowski (Morel 1974), {:g} PSU",
                    water.salinity);
    for (const SpeciesAmount& amount : water.amounts) text += "; " + amount_source(water, amount);
    if (small_ppm + large_ppm == 0) return text;
    text += fmt::format(
        "; Kopelevich's particles (1983; Mobley 1994), {:.4g} ppm small, "
        "{:.4g} ppm large",
        small_ppm, large_ppm);
    if (!water.preset.empty() && !(water.small_ppm && water.large_ppm))
        text += fmt::format(", to scatter as {} (Williamson and Hollins 2022)",
                            jerlov_preset(water.preset).name);
    return text;
}

std::string grid_source(const WaterDesc& water, const VolumeDesc& volume,
                        const GridMappingDesc& grid) {
    const std::string place =
        fmt::format("grid '{}' of {}: 1 unit is ", grid.grid, volume.file.filename().string());
    if (!grid.optics) {
        std::vector<std::string> parts;
        if (grid.amounts.empty() || grid.small_ppm > 0)
            parts.push_back(fmt::format("{:g} ppm small", grid.small_ppm));
        if (grid.amounts.empty() || grid.large_ppm > 0)
            parts.push_back(fmt::format("{:g} ppm large", grid.large_ppm));
        for (const SpeciesAmount& amount : grid.amounts) {
            const SpeciesDesc& species = water.species[amount.species];
            parts.push_back(fmt::format("{:.4g} {} {}", concentration_of(species, amount, water),
                                        unit_of(species), species.name));
        }
        return place + fmt::format("{}", fmt::join(parts, ", "));
    }
    return place + (grid.optics->phase ? "coefficients as given, with a phase function"
                                       : "coefficients as given, with the water's phase function");
}

}  // namespace

std::vector<std::string> water_sources(const WaterDesc& water,
                                       const std::vector<VolumeDesc>& volumes, double small_ppm,
                                       double large_ppm) {
    std::vector<std::string> lines{absorption_source(water, small_ppm, large_ppm),
                                   scattering_source(water, small_ppm, large_ppm)};
    if (water.profile)
        lines.push_back(
            fmt::format("profile: {}, by depth; where it changes, what is above is the "
                        "least of it",
                        water.profile->file.filename().string()));
    for (const VolumeDesc& volume : volumes)
        for (const GridMappingDesc& grid : volume.grids)
            lines.push_back(grid_source(water, volume, grid));
    return lines;
}

}  // namespace uw
