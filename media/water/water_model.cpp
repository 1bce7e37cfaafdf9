#include "media/water/water_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <variant>

#include "core/base/error.h"
#include "core/scene/dispersion.h"
#include "media/water/depth_profile.h"
#include "media/water/phase_functions.h"
#include "media/water/species.h"
#include "media/water/water_types.h"

namespace uw {

namespace {

/// A species in one band, where its phase function is its own.
struct SpeciesInBand {
    std::size_t species, band;

    friend bool operator==(const SpeciesInBand&, const SpeciesInBand&) = default;
};

/// The source of a phase function of the medium: equal sources share one.
using PhaseSource = std::variant<PhaseFunctionDesc, KopelevichClass, SpeciesInBand>;

/// The limit on the species_work of all species in all bands: some ten minutes of two processors.
constexpr double k_max_species_work = 2e11;

/// Assembles the model step by step: the uniform water first, since grids may refer to it.
class Builder {
  public:
    Builder(const WaterDesc& water, const ProgressCallback& progress);

    /// Sums the work of the species that will be needed, so that progress refers to all of them.
    /// Throws InputError if it is too much.
    void expect(const std::vector<VolumeDesc>& volumes);
    void add_uniform();
    void add_strata();
    void add_grid(const GridMappingDesc& grid, std::vector<GridLoad>& loads);
    WaterModel finish();

    WaterModel model;

  private:
    std::size_t phase_index(const PhaseDesc& desc);
    template <class Make>
    std::size_t phase_index_of(const PhaseSource& source, const Make& make);
    static Spectrum& scattering(OpticalCoefficients& x, std::size_t phase);

    void warn_of_held_wavelengths(std::size_t species);
    /// Adds the excess of a quantity over its least value to a constituent.
    void add_curve(int constituent, std::vector<double> values);
    void add_coefficient_curves(const std::vector<double>& values, bool scatters);
    /// Adds particles, of which `absorbing_ppm` absorb; by default all of them.
    void add_species(std::size_t species, double ppm, double absorbing_ppm, OpticalCoefficients& x);
    void add_species(std::size_t species, double ppm, OpticalCoefficients& x) {
        add_species(species, ppm, ppm, x);
    }
    int species_constituent(std::size_t species);
    int known_particles(const std::string& name) const;
    int optics_constituent(const GridMappingDesc& grid);
    void scatter_like_water(const GridMappingDesc& grid, OpticalCoefficients& x) const;
    std::string unique_name(const std::string& wanted) const;
    void drop_unused_phases();

    struct OpticsEntry {
        const GridMappingDesc::Optics* optics;
        int constituent;
    };

    const WaterDesc& water_;
    const std::vector<SpeciesDesc> species_;  // the water's, then Kopelevich's
    const std::size_t small_, large_;         // indices of the latter
    const ProgressCallback& progress_;
    const std::size_t band_count_;
    std::optional<DepthProfile> profile_;
    std::vector<Strata::Curve> curves_;
    double expected_ = 0, done_ = 0;          // species_work of the species to be computed
    std::vector<bool> known_species_;         // the species that have been requested
    std::vector<PhaseSource> phase_sources_;  // one per medium phase function
    std::vector<OpticsEntry> optics_;
};

void check_bands(const WaterDesc& water) {
    if (water.bands_nm.empty() || water.bands_nm.size() > static_cast<std::size_t>(k_max_bands))
        throw InputError(fmt::format("{}: {} bands; give 1 to {} wavelengths in nm", water.where,
                                     water.bands_nm.size(), k_max_bands));
    for (const double band : water.bands_nm)
        if (!(band >= 100 && band <= 10000))
            throw InputError(fmt::format(
                "{}: band {} is not a wavelength of light in water; give nanometres, 100 to 10000",
                water.where, band));
}

void check_per_band(const PerBand& values, std::size_t bands, const std::string& what,
                    const SourceLocation& where) {
    if (values.size() != bands)
        throw InputError(fmt::format("{}: {} has {} values for {} bands; give one per band", where,
                                     what, values.size(), bands));
}

/// Whether coefficients and phase function are equal, regardless of where they are written.
bool same_optics(const GridMappingDesc::Optics& a, const GridMappingDesc::Optics& b) {
    const auto function = [](const GridMappingDesc::Optics& optics) {
        return optics.phase ? std::optional(optics.phase->function) : std::nullopt;
    };
    return a.absorption == b.absorption && a.scattering == b.scattering &&
           function(a) == function(b);
}

/// The least values of a profile [depth * bands + band], by band.
Spectrum min_by_band(const std::vector<double>& values, std::size_t bands) {
    Spectrum least{};
    for (std::size_t i = 0; i < values.size(); ++i)
        least[i % bands] = i < bands ? values[i] : std::min(least[i % bands], values[i]);
    return least;
}

bool is_zero(const Spectrum& x) {
    return std::all_of(x.begin(), x.end(), [](double value) { return value == 0; });
}

Builder::Builder(const WaterDesc& water, const ProgressCallback& progress)
    : water_(water),
      species_(all_species(water)),
      small_(water.species.size()),
      large_(small_ + 1),
      progress_(progress),
      band_count_(water.bands_nm.size()),
      known_species_(species_.size(), false) {
    check_bands(water);
    if (water.absorption) check_per_band(*water.absorption, band_count_, "absorption", water.where);
    if (water.scattering)
        check_per_band(water.scattering->b, band_count_, "scattering.b", water.where);
    model.medium.wavelengths_nm = water.bands_nm;
}

template <class Make>
std::size_t Builder::phase_index_of(const PhaseSource& source, const Make& make) {
    const auto found = std::find(phase_sources_.begin(), phase_sources_.end(), source);
    const auto index = static_cast<std::size_t>(found - phase_sources_.begin());
    if (found == phase_sources_.end()) {
        model.medium.phase_functions.push_back(make());
        phase_sources_.push_back(source);
    }
    return index;
}

std::size_t Builder::phase_index(const PhaseDesc& desc) {
    return phase_index_of(desc.function, [&] { return make_phase_function(desc, model.warnings); });
}

Spectrum& Builder::scattering(OpticalCoefficients& x, std::size_t phase) {
    if (x.scattering.size() <= phase) x.scattering.resize(phase + 1);
    return x.scattering[phase];
}

void Builder::add_uniform() {
    const JerlovPreset* preset = nullptr;
    try {
        if (!water_.preset.empty()) preset = &jerlov_preset(water_.preset);
    } catch (const InputError& error) {
        throw InputError(fmt::format("{}: {}", water_.where, error.what()));
    }
    OpticalCoefficients& uniform = model.medium.uniform;
    if (water_.profile) {
        profile_ = read_depth_profile(water_);
        model.warnings = profile_->warnings;
    }
    if (profile_ && !profile_->absorption.empty())
        uniform.absorption = min_by_band(profile_->absorption, band_count_);
    else
        uniform.absorption = uniform_absorption(water_, preset, model.warnings);

    if (water_.scattering) {
        Spectrum& b = scattering(uniform, phase_index(water_.scattering->phase));
        if (profile_ && !profile_->scattering.empty())
            b = min_by_band(profile_->scattering, band_count_);
        else
            std::ranges::copy(water_.scattering->b, b.begin());
        if (water_.small_ppm.value_or(0) > 0 || water_.large_ppm.value_or(0) > 0)
            model.warnings.push_back(fmt::format(
                "{}: scattering is given, so particles are not used; remove one or the other",
                water_.where));
        return;
    }
    const PhaseDesc molecules{MolecularPhaseDesc{}, water_.where};
    Spectrum& b = scattering(uniform, phase_index(molecules));
    for (std::size_t i = 0; i < band_count_; ++i)
        b[i] = water_scattering(water_.bands_nm[i], water_.salinity);
    model.small_ppm = water_.small_ppm.value_or(preset ? preset->small_ppm : 0);
    model.large_ppm = water_.large_ppm.value_or(preset ? preset->large_ppm : 0);
    if (profile_ && !profile_->small.empty()) model.small_ppm = std::ranges::min(profile_->small);
    if (profile_ && !profile_->large.empty()) model.large_ppm = std::ranges::min(profile_->large);
    // A preset's measured absorption includes what its own particles absorb.
    const bool measured = preset && !water_.absorption;
    const double small_counted = measured ? preset->small_ppm : 0;
    const double large_counted = measured ? preset->large_ppm : 0;
    add_species(small_, model.small_ppm, std::max(0.0, model.small_ppm - small_counted), uniform);
    add_species(large_, model.large_ppm, std::max(0.0, model.large_ppm - large_counted), uniform);
    for (const SpeciesAmount& amount : water_.amounts)
        add_species(amount.species, concentration_of(species_[amount.species], amount, water_),
                    uniform);
    if (profile_)
        for (const DepthProfile::OfSpecies& of : profile_->species)
            add_species(of.species, std::ranges::min(of.concentration), uniform);
}

void Builder::expect(const std::vector<VolumeDesc>& volumes) {
    std::vector<bool> used(species_.size(), water_.profile.has_value());
    const auto use = [&](const std::vector<SpeciesAmount>& amounts) {
        for (const SpeciesAmount& amount : amounts) used[amount.species] = true;
    };
    use(water_.amounts);
    for (const VolumeDesc& volume : volumes)
        for (const GridMappingDesc& grid : volume.grids) use(grid.amounts);
    std::size_t most = 0;  // the species with the most work
    double work_of_most = 0;
    for (std::size_t i = 0; i < species_.size(); ++i) {
        if (!used[i]) continue;
        double work = 0;
        for (const double band : water_.bands_nm) work += species_work(species_[i], band, water_);
        expected_ += work;
        if (work > work_of_most) most = i, work_of_most = work;
    }
    if (expected_ > k_max_species_work)
        throw InputError(fmt::format(
            "{}: to compute the species takes {:.2g} times the work that is allowed, most of it "
            "{}; "
            "give smaller greatest diameters, fewer species or fewer bands",
            species_[most].where, expected_ / k_max_species_work, species_[most].name));
}

void Builder::warn_of_held_wavelengths(std::size_t species) {
    const std::vector<double> known = measured_wavelengths(species_[species]);
    if (known.empty()) return;
    constexpr double k_near_nm = 15;
    std::string outside;
    for (const double band : water_.bands_nm)
        if (band < known.front() - k_near_nm || band > known.back() + k_near_nm)
            outside += fmt::format("{}{:g}", outside.empty() ? "" : ", ", band);
    if (outside.empty()) return;
    const std::string range =
        known.size() == 1 ? fmt::format("at {:g} nm alone", known.front())
                          : fmt::format("from {:g} to {:g} nm", known.front(), known.back());
    model.warnings.push_back(
        fmt::format("{}: its scattering was measured {}, and is taken to be the same at {} nm",
                    species_[species].where, range, outside));
}

void Builder::add_species(std::size_t species, double ppm, double absorbing_ppm,
                          OpticalCoefficients& x) {
    if (ppm == 0) return;
    const std::optional<KopelevichClass>& kopelevich = species_[species].kopelevich;
    const bool is_first = !known_species_[species];
    known_species_[species] = true;
    if (is_first) {
        warn_of_held_wavelengths(species);
        if (auto warning = sizes_warning(species_[species]))
            model.warnings.push_back(std::move(*warning));
    }
    for (std::size_t i = 0; i < band_count_; ++i) {
        const double work =
            is_first ? species_work(species_[species], water_.bands_nm[i], water_) : 0;
        ProgressCallback tell;
        if (progress_)
            tell = [&](double fraction) {
                progress_((done_ + fraction * work) / std::max(expected_, done_ + work));
            };
        const SpeciesOptics optics =
            species_optics(species_[species], water_.bands_nm[i], water_, tell);
        done_ += work;
        const PhaseSource source =
            kopelevich ? PhaseSource(*kopelevich) : PhaseSource(SpeciesInBand{species, i});
        const std::size_t phase = phase_index_of(source, [&] { return optics.phase; });
        scattering(x, phase)[i] += ppm * optics.scattering;
        x.absorption[i] += absorbing_ppm * optics.absorption;
    }
}

int Builder::known_particles(const std::string& name) const {
    const std::vector<Constituent>& all = model.medium.constituents;
    const auto found = std::find_if(all.begin(), all.end(), [&](const Constituent& other) {
        return (other.unit == "ppm" || other.unit == "sample") && other.name == name;
    });
    return found == all.end() ? -1 : static_cast<int>(found - all.begin());
}

int Builder::species_constituent(std::size_t species) {
    const std::string& name = species_[species].name;
    if (const int known = known_particles(name); known >= 0) return known;
    Constituent particles{name, unit_of(species_[species]), {}};
    add_species(species, 1, particles.per_unit);
    model.medium.constituents.push_back(std::move(particles));
    return model.medium.constituent_count() - 1;
}

std::string Builder::unique_name(const std::string& wanted) const {
    const auto taken = [&](const std::string& name) {
        return std::ranges::count(names_of(species_), name) > 0 ||
               std::any_of(model.medium.constituents.begin(), model.medium.constituents.end(),
                           [&](const Constituent& other) { return other.name == name; });
    };
    std::string name = wanted;
    for (int i = 2; taken(name); ++i) name = fmt::format("{}-{}", wanted, i);
    return name;
}

void Builder::scatter_like_water(const GridMappingDesc& grid, OpticalCoefficients& x) const {
    const std::vector<Spectrum>& water = model.medium.uniform.scattering;
    x.scattering.resize(std::max(x.scattering.size(), water.size()));
    for (std::size_t i = 0; i < band_count_; ++i) {
        const double b = grid.optics->scattering[i];
        if (b == 0) continue;
        double total = 0;
        for (const Spectrum& b_m : water) total += b_m[i];
        if (total == 0)
            throw InputError(
                fmt::format("{}: {} scatters at {} nm and gives no phase function, "
                            "but the water does not scatter there; give it a phase",
                            grid.where, grid.grid, water_.bands_nm[i]));
        for (std::size_t m = 0; m < water.size(); ++m)
            x.scattering[m][i] = b * (water[m][i] / total);
    }
}

int Builder::optics_constituent(const GridMappingDesc& grid) {
    const GridMappingDesc::Optics& optics = *grid.optics;
    for (const OpticsEntry& entry : optics_)
        if (same_optics(*entry.optics, optics)) return entry.constituent;
    check_per_band(optics.absorption, band_count_, "absorption", grid.where);
    check_per_band(optics.scattering, band_count_, "scattering", grid.where);
    Constituent own{unique_name(grid.grid), "1", {}};
    std::copy(optics.absorption.begin(), optics.absorption.end(), own.per_unit.absorption.begin());
    if (optics.phase) {
        Spectrum& b = scattering(own.per_unit, phase_index(*optics.phase));
        std::copy(optics.scattering.begin(), optics.scattering.end(), b.begin());
    } else {
        scatter_like_water(grid, own.per_unit);
    }
    model.medium.constituents.push_back(std::move(own));
    const int index = model.medium.constituent_count() - 1;
    optics_.push_back({&optics, index});
    return index;
}

void Builder::add_grid(const GridMappingDesc& grid, std::vector<GridLoad>& loads) {
    if (grid.optics) {
        loads.push_back({optics_constituent(grid), 1});
        return;
    }
    const auto add = [&](std::size_t species, double per_unit) {
        if (per_unit != 0) loads.push_back({species_constituent(species), per_unit});
    };
    add(small_, grid.small_ppm);
    add(large_, grid.large_ppm);
    for (const SpeciesAmount& amount : grid.amounts)
        add(amount.species, concentration_of(species_[amount.species], amount, water_));
}

void Builder::add_curve(int constituent, std::vector<double> values) {
    const double least = std::ranges::min(values);
    for (double& value : values) value -= least;
    curves_.push_back({static_cast<std::size_t>(constituent), std::move(values)});
}

/// Whether the excess of each band over its least value is that of `band` times a factor, which
/// becomes its entry of `factors`: then one constituent represents all bands.
bool change_alike(const std::vector<double>& values, const Spectrum& least, std::size_t band,
                  std::size_t bands, Spectrum& factors) {
    double most = 0;
    for (std::size_t i = band; i < values.size(); i += bands)
        most = std::max(most, values[i] - least[band]);
    for (std::size_t b = 0; b < bands; ++b) {
        double its = 0;
        for (std::size_t i = b; i < values.size(); i += bands)
            its = std::max(its, values[i] - least[b]);
        factors[b] = its / most;
        for (std::size_t i = 0; i < values.size(); i += bands)
            if (std::abs(values[i + b] - least[b] - factors[b] * (values[i + band] - least[band])) >
                1e-12 * most)
                return false;
    }
    return true;
}

void Builder::add_coefficient_curves(const std::vector<double>& values, bool scatters) {
    if (values.empty()) return;
    const Spectrum least = min_by_band(values, band_count_);
    const auto changes = [&](std::size_t band) {
        for (std::size_t i = band; i < values.size(); i += band_count_)
            if (values[i] > least[band]) return true;
        return false;
    };
    const auto add = [&](std::size_t band, const Spectrum& factors) {
        const std::string name = scatters ? "scattering" : "absorption";
        Constituent constituent{unique_name(name), "1/m", {}};
        if (scatters)
            scattering(constituent.per_unit, phase_index(water_.scattering->phase)) = factors;
        else
            constituent.per_unit.absorption = factors;
        model.medium.constituents.push_back(std::move(constituent));
        std::vector<double> curve;
        for (std::size_t i = band; i < values.size(); i += band_count_) curve.push_back(values[i]);
        add_curve(model.medium.constituent_count() - 1, std::move(curve));
    };
    std::size_t first = 0;
    while (first < band_count_ && !changes(first)) ++first;
    if (first == band_count_) return;
    if (Spectrum factors{}; change_alike(values, least, first, band_count_, factors)) {
        add(first, factors);
        return;
    }
    for (std::size_t band = first; band < band_count_; ++band) {
        if (!changes(band)) continue;
        Spectrum own{};
        own[band] = 1;
        add(band, own);
    }
}

void Builder::add_strata() {
    if (!profile_) return;
    const auto changes = [](const std::vector<double>& values) {
        return !values.empty() && std::ranges::max(values) > std::ranges::min(values);
    };
    if (changes(profile_->small)) add_curve(species_constituent(small_), profile_->small);
    if (changes(profile_->large)) add_curve(species_constituent(large_), profile_->large);
    for (const DepthProfile::OfSpecies& of : profile_->species)
        if (changes(of.concentration)) add_curve(species_constituent(of.species), of.concentration);
    add_coefficient_curves(profile_->absorption, false);
    add_coefficient_curves(profile_->scattering, true);
    if (curves_.empty()) return;
    const WaterSurfaceDesc& surface = water_.surface.value();
    model.strata = std::make_shared<Strata>(surface.point, surface.normal, profile_->depths,
                                            std::move(curves_), surface.n.has_value());
}

void Builder::drop_unused_phases() {
    Medium& medium = model.medium;
    std::vector<OpticalCoefficients*> all{&medium.uniform};
    for (Constituent& constituent : medium.constituents) all.push_back(&constituent.per_unit);
    for (OpticalCoefficients* x : all) x->scattering.resize(medium.phase_functions.size());
    for (std::size_t m = medium.phase_functions.size(); m-- > 0;) {
        const bool unused = std::all_of(all.begin(), all.end(), [m](OpticalCoefficients* x) {
            return is_zero(x->scattering[m]);
        });
        if (!unused) continue;
        const auto at = static_cast<std::ptrdiff_t>(m);
        medium.phase_functions.erase(medium.phase_functions.begin() + at);
        for (OpticalCoefficients* x : all) x->scattering.erase(x->scattering.begin() + at);
    }
}

WaterModel Builder::finish() {
    drop_unused_phases();
    return std::move(model);
}

}  // namespace

WaterModel build_water_model(const WaterDesc& water, const std::vector<VolumeDesc>& volumes,
                             const ProgressCallback& progress) {
    Builder builder(water, progress);
    builder.expect(volumes);
    builder.add_uniform();
    for (const VolumeDesc& volume : volumes) {
        std::vector<std::vector<GridLoad>>& loads = builder.model.loads.emplace_back();
        for (const GridMappingDesc& grid : volume.grids)
            builder.add_grid(grid, loads.emplace_back());
    }
    builder.add_strata();
    return builder.finish();
}

std::vector<OpticalCoefficients> coefficients_by_depth(const WaterModel& model) {
    if (!model.strata) return {};
    std::vector<OpticalCoefficients> all(model.strata->depths().size(), model.medium.uniform);
    for (const Strata::Curve& curve : model.strata->curves()) {
        const OpticalCoefficients& unit = model.medium.constituents[curve.constituent].per_unit;
        for (std::size_t i = 0; i < all.size(); ++i) {
            all[i].absorption += curve.values[i] * unit.absorption;
            for (std::size_t m = 0; m < unit.scattering.size(); ++m)
                all[i].scattering[m] += curve.values[i] * unit.scattering[m];
        }
    }
    return all;
}

namespace {

constexpr double k_rounding_ppm = 1e-6;

void refuse_other_water(const WaterDesc& water, const std::vector<VolumeDesc>& volumes,
                        bool is_small) {
    if (water.profile) {
        const DepthProfile profile = read_depth_profile(water);
        if (!(is_small ? profile.small : profile.large).empty())
            throw UsageError(fmt::format(
                "the {} particles change with depth; take them out of {}, or take another "
                "derivative",
                is_small ? "small" : "large", water.profile->file.filename().string()));
    }
    if (water.scattering)
        throw UsageError(
            "the water's scattering is given, so that it has no particles; remove "
            "water.scattering, or take the derivative water.scattering");
    const auto scatters_like_water = [](const GridMappingDesc& grid) {
        return grid.optics && !grid.optics->phase &&
               std::ranges::any_of(grid.optics->scattering, [](double b) { return b > 0; });
    };
    for (const VolumeDesc& volume : volumes)
        for (const GridMappingDesc& grid : volume.grids) {
            if (!scatters_like_water(grid)) continue;
            throw UsageError(
                fmt::format("the grid {} scatters like the water, whose phase function changes "
                            "with its particles; give the grid a phase",
                            grid.grid));
        }
}

}  // namespace

Medium with_one_more_ppm(const WaterModel& model, const WaterDesc& water,
                         const std::vector<VolumeDesc>& volumes, WaterParticles particles) {
    const bool is_small = particles == WaterParticles::small;
    refuse_other_water(water, volumes, is_small);
    const SpeciesDesc species = all_species(water)[water.species.size() + (is_small ? 0 : 1)];
    bool absorbs = true;
    if (!water.preset.empty() && !water.absorption) {
        const JerlovPreset& preset = jerlov_preset(water.preset);
        absorbs = is_small ? model.small_ppm >= preset.small_ppm - k_rounding_ppm
                           : model.large_ppm >= preset.large_ppm - k_rounding_ppm;
    }
    Medium medium = model.medium;
    std::vector<Spectrum>& scattering = medium.uniform.scattering;
    for (std::size_t band = 0; band < water.bands_nm.size(); ++band) {
        const SpeciesOptics optics = species_optics(species, water.bands_nm[band], water);
        const auto found = std::ranges::find(medium.phase_functions, optics.phase);
        const auto phase = static_cast<std::size_t>(found - medium.phase_functions.begin());
        if (found == medium.phase_functions.end()) {
            medium.phase_functions.push_back(optics.phase);
            scattering.emplace_back();
            for (Constituent& constituent : medium.constituents)
                constituent.per_unit.scattering.emplace_back();
        }
        scattering[phase][band] += optics.scattering;
        if (absorbs) medium.uniform.absorption[band] += optics.absorption;
    }
    return medium;
}

}  // namespace uw
