#include "media/water/species.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <mutex>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/base/csv_table.h"
#include "core/base/input_files.h"
#include "core/base/parallel.h"
#include "core/scene/dispersion.h"
#include "media/water/measured_vsf.h"
#include "media/water/mie.h"
#include "media/water/species_cache.h"
#include "media/water/water_types.h"

namespace uw {

namespace {

/// Diameters, and the volume of particles per interval of their logarithm, which integrates to 1.
class VolumeBySize {
  public:
    explicit VolumeBySize(const SpeciesDesc& species) : sizes_(species.sizes) {
        if (sizes_.type == SizesDesc::Type::table) read_table(species);
        const bool has_ends = sizes_.greatest > 0;
        if (!has_ends) find_ends_of_lognormal();
        first_ = std::log(sizes_.least), last_ = std::log(sizes_.greatest);
        constexpr int k_steps = 4096;
        const double step = (last_ - first_) / k_steps;
        double sum = 0, number = 0;
        for (int i = 0; i < k_steps; ++i) {
            const double x = first_ + (i + 0.5) * step;
            sum += step * value(x);
            number += step * value(x) / volume(std::exp(x));
        }
        if (!(sum > 0 && std::isfinite(sum)))
            throw InputError(
                fmt::format("{}: its size distribution is 0 everywhere; mend size", species.where));
        factor_ = 1 / sum;
        mean_volume_ = sum / number;
        if (!has_ends) mean_volume_ = volume_fraction(first_, last_) * mean_volume_of_lognormal();
    }

    double first() const { return first_; }
    double last() const { return last_; }
    double greatest() const { return sizes_.greatest; }
    double operator()(double log_diameter) const { return factor_ * value(log_diameter); }
    /// The volume of a particle [m^3], counting those that are left out as 0.
    double mean_volume() const { return mean_volume_; }

    /// The fractions of the volume of a log-normal distribution without ends in particles that are
    /// too small and too large to be computed.
    struct LeftOut {
        double small = 0, large = 0;
    };
    LeftOut left_out() const {
        constexpr double k_all = std::numeric_limits<double>::infinity();
        return {volume_fraction(-k_all, std::log(k_min_diameter)),
                volume_fraction(std::log(k_max_diameter), k_all)};
    }

    /// A key of everything on which the distribution depends.
    std::string text() const {
        std::string text = fmt::format("sizes {} {:a} {:a} {:a} {:a} {:a} {:a}",
                                       static_cast<int>(sizes_.type), sizes_.least, sizes_.greatest,
                                       sizes_.exponent, sizes_.median, sizes_.sigma, sizes_.mode);
        for (std::size_t i = 0; i < curve_.x.size(); ++i)
            text += fmt::format(" {:a} {:a}", curve_.x[i], curve_.y[i]);
        return text;
    }

    static double volume(double diameter) {
        return std::numbers::pi / 6 * diameter * diameter * diameter;
    }

  private:
    // A log-normal distribution weighted by the diameter to the power k is log-normal again,
    // shifted by k times its variance. Cross sections have k from 2 to 3, or 6 where particles are
    // smaller than the wavelength. Less than 1e-4 of them lie beyond 4 deviations.
    void find_ends_of_lognormal() {
        constexpr double k_reach = 4, k_wavelength = 1e-6;
        const double deviation = std::log(sizes_.sigma);
        const auto place_of = [&](double diameter) {
            return std::log(diameter / sizes_.median) / deviation;
        };
        const double highest =
            std::max(3 * deviation, std::min(6 * deviation, place_of(k_wavelength)));
        const double last = std::min(highest + k_reach, place_of(k_max_diameter));
        const double first =
            std::max(std::min(2 * deviation, last) - k_reach, place_of(k_min_diameter));
        sizes_.least = sizes_.median * std::exp(deviation * first);
        sizes_.greatest = sizes_.median * std::exp(deviation * last);
    }

    /// The fraction of the volume of a log-normal distribution between two logarithms of diameters.
    double volume_fraction(double first, double last) const {
        const double deviation = std::log(sizes_.sigma);
        const double middle = std::log(sizes_.median) + 3 * deviation * deviation;
        const double a = (first - middle) / (std::numbers::sqrt2 * deviation);
        const double b = (last - middle) / (std::numbers::sqrt2 * deviation);
        // Tails are computed directly, not as differences from 1.
        return a > 0 ? 0.5 * (std::erfc(a) - std::erfc(b)) : 0.5 * (std::erfc(-b) - std::erfc(-a));
    }

    double mean_volume_of_lognormal() const {
        const double deviation = std::log(sizes_.sigma);
        return volume(sizes_.median) * std::exp(4.5 * deviation * deviation);
    }

    void read_table(const SpeciesDesc& species) {
        curve_ = read_csv_file(sizes_.file, species.where).curve("diameter_um", "volume");
        for (double& diameter : curve_.x) {
            if (!(diameter >= 0.01 && diameter <= 5000))
                throw InputError(fmt::format("{}: diameter {} um of {}; give 0.01 to 5000",
                                             species.where, diameter,
                                             sizes_.file.filename().string()));
            diameter = std::log(diameter * 1e-6);
        }
        if (curve_.x.size() < 2 ||
            std::ranges::any_of(curve_.y, [](double v) { return !(v >= 0); }))
            throw InputError(fmt::format("{}: {} needs two classes or more, of volumes >= 0",
                                         species.where, sizes_.file.filename().string()));
        sizes_.least = std::exp(curve_.first());
        sizes_.greatest = std::exp(curve_.last());
    }

    double value(double log_diameter) const {
        // Relative to the greatest, so that no power overflows.
        const double d = log_diameter - std::log(sizes_.greatest);
        switch (sizes_.type) {
            case SizesDesc::Type::junge:
                return std::exp((4 - sizes_.exponent) * d);
            case SizesDesc::Type::lognormal: {
                const double deviation = std::log(sizes_.sigma);
                const double t = (log_diameter - std::log(sizes_.median)) / deviation;
                return std::exp(3 * d - t * t / 2);
            }
            case SizesDesc::Type::gamma: {
                const double ratio = std::exp(log_diameter) / sizes_.mode;
                return std::exp((4 + sizes_.exponent) * d - sizes_.exponent * ratio);
            }
            case SizesDesc::Type::table:
                break;
        }
        return curve_.value(log_diameter);
    }

    SizesDesc sizes_;
    SampledCurve curve_;
    double first_ = 0, last_ = 0, factor_ = 1, mean_volume_ = 0;
};

std::complex<double> index_at(const ParticleIndexDesc& index, double wavelength_nm,
                              const SourceLocation& where) {
    constexpr double k_reference_nm = 550;
    if (index.file.empty())
        return {index.n, index.k * std::exp(-index.k_slope * (wavelength_nm - k_reference_nm))};
    const CsvTable table = read_csv_file(index.file, where);
    const SampledCurve n = table.curve("wavelength_nm", "n"), k = table.curve("wavelength_nm", "k");
    const std::complex<double> value{n.value(wavelength_nm), k.value(wavelength_nm)};
    if (!(value.real() >= 0.3 && value.real() <= 5 && value.imag() >= 0 && value.imag() <= 5))
        throw InputError(fmt::format(
            "{}: {} gives the index {} + {} i at {:g} nm; n is from 0.3 "
            "to 5 against water, k from 0 to 5",
            where, index.file.filename().string(), value.real(), value.imag(), wavelength_nm));
    return value;
}

/// Scattering angles [rad], fine where spheres up to `max_x` have their forward peak.
std::vector<double> scattering_angles(double max_x) {
    std::vector<double> angles{0};
    constexpr int k_per_octave = 32;
    constexpr double k_widest = 30 * std::numbers::pi / 180;
    constexpr int k_rest = 200;  // steps of 0.75 degrees
    for (double psi = 0.3 / std::max(max_x, 1.0); psi < k_widest;
         psi *= std::exp2(1.0 / k_per_octave))
        angles.push_back(psi);
    for (int i = 0; i < k_rest; ++i)
        angles.push_back(k_widest + i * (std::numbers::pi - k_widest) / k_rest);
    angles.push_back(std::numbers::pi);
    return angles;
}

/// The value at `x` of the polynomial through the points (xs, ys).
double interpolated(std::span<const double> xs, std::span<const double> ys, double x) {
    double y = 0;
    for (std::size_t i = 0; i < xs.size(); ++i) {
        double weight = 1;
        for (std::size_t k = 0; k < xs.size(); ++k)
            if (k != i) weight *= (x - xs[k]) / (xs[i] - xs[k]);
        y += weight * ys[i];
    }
    return y;
}

/// A table of the angles [degrees] with one more between each two, except between 0 and the first,
/// by a cubic through their neighbours, all in logarithms. The power laws of TabulatedPhase are
/// chords of a curved function, an error of 1.6e-4 of the integral for bubbles; intervals of half
/// the width have a quarter of it, at no cost in terms of the Mie series.
SampledCurve table_with_middles(std::span<const double> angles, std::span<const double> phase) {
    const auto degrees = [](double psi) {
        return psi == std::numbers::pi ? 180 : psi * (180 / std::numbers::pi);
    };
    std::vector<double> x, y;
    for (std::size_t i = 1; i < angles.size(); ++i) {
        x.push_back(std::log(angles[i]));
        y.push_back(std::log(std::max(phase[i], 1e-300)));
    }
    SampledCurve curve;
    const auto add = [&](double psi, double value) {
        curve.x.push_back(degrees(psi));
        curve.y.push_back(value);
    };
    add(angles[0], phase[0]);
    for (std::size_t i = 0; i < x.size(); ++i) {
        add(angles[i + 1], phase[i + 1]);
        if (i + 1 == x.size()) break;
        const std::size_t first = i > 0 ? i - 1 : 0;
        const std::size_t count = std::min(i + 3, x.size()) - first;
        const double middle = 0.5 * (x[i] + x[i + 1]);
        add(std::exp(middle), std::exp(interpolated(std::span(x).subspan(first, count),
                                                    std::span(y).subspan(first, count), middle)));
    }
    return curve;
}

/// Sums over sizes, per unit of volume.
struct Sums {
    double scattering = 0, absorption = 0;  // cross sections [1/m]
    std::vector<double> phase;              // differential cross section [1/(m sr)]
};

void add(Sums& sums, const Sums& more, double factor) {
    sums.scattering += factor * more.scattering;
    sums.absorption += factor * more.absorption;
    for (std::size_t i = 0; i < sums.phase.size(); ++i) sums.phase[i] += factor * more.phase[i];
}

class SizeAverage {
  public:
    SizeAverage(const SpeciesDesc& species, double wavelength_nm, double n_water)
        : sizes_(species), wave_number_(2 * std::numbers::pi * n_water / (wavelength_nm * 1e-9)) {
        sphere_index_ = index_at(species.index, wavelength_nm, species.where);
        if (species.coat) {
            coat_index_ = index_at(species.coat->index, wavelength_nm, species.where);
            coat_thickness_ = species.coat->thickness;
        }
        angles_ = scattering_angles(wave_number_ * sizes_.greatest() / 2);
        for (const double psi : angles_) cosines_.push_back(std::cos(psi));
    }

    const std::vector<double>& angles() const { return angles_; }

    /// The number of terms for all sizes, which are equidistant in the logarithm of their
    /// diameters.
    double work() const {
        const double greatest = wave_number_ * std::exp(sizes_.last()) / 2;
        const double least = wave_number_ * std::exp(sizes_.first()) / 2;
        const double octaves = sizes_.last() - sizes_.first();
        const double mean = octaves > 0 ? (greatest - least) / octaves : greatest;
        constexpr double k_fewest_orders = 8;
        return static_cast<double>(k_max_sizes) * static_cast<double>(angles_.size()) *
               (mean + k_fewest_orders);
    }

    /// A key of everything on which the sums depend, and of the version of the method.
    std::string text() const {
        const auto of = [](std::complex<double> index) {
            return fmt::format("{:a} {:a}", index.real(), index.imag());
        };
        return fmt::format("{} wave number {:a} index {} coat {:a} {} angles {} version {}",
                           sizes_.text(), wave_number_, of(sphere_index_), coat_thickness_,
                           of(coat_index_), angles_.size(), k_version);
    }

    /// The trapezoidal rule, to which the sizes halfway are added again and again.
    Sums converged(const ProgressCallback& progress) const {
        Progress told(progress);
        const double length = sizes_.last() - sizes_.first();
        Sums sum = none();
        add(sum, sum_over(sizes_.first(), length, 2, told), 0.5);  // the ends
        double step = length / k_first;
        add(sum, sum_over(sizes_.first() + step, step, k_first - 1, told), 1);
        for (std::size_t count = k_first;; count *= 2, step /= 2) {
            Sums fine = sum;
            add(fine, sum_over(sizes_.first() + 0.5 * step, step, count, told), 1);
            Sums before = none(), after = none();
            add(before, sum, step);
            add(after, fine, 0.5 * step);
            if (2 * count == k_max_sizes || agree(before, after)) return after;
            sum = std::move(fine);
        }
    }

  private:
    static constexpr std::size_t k_first = 128, k_max_sizes = 2048;
    /// To be increased with every change of the results: those of other versions are not reused.
    static constexpr int k_version = 2;

    /// Counts the sizes that are done. Their number may be less than the maximum.
    class Progress {
      public:
        explicit Progress(const ProgressCallback& tell) : tell_(tell) {}
        void add(std::size_t sizes) {
            if (!tell_) return;
            const std::scoped_lock lock(mutex_);
            done_ += sizes;
            tell_(static_cast<double>(done_) / k_max_sizes);
        }

      private:
        const ProgressCallback& tell_;
        std::mutex mutex_;
        std::size_t done_ = 0;
    };

    Sums none() const { return {0, 0, std::vector<double>(angles_.size(), 0)}; }

    /// The sum over `count` logarithms of diameters, `step` apart.
    Sums sum_over(double first, double step, std::size_t count, Progress& progress) const {
        constexpr std::size_t k_chunk = 16;
        std::vector<Sums> parts((count + k_chunk - 1) / k_chunk);
        parallel_for(parts.size(), [&](std::size_t i) {
            // The largest, which take longest, first.
            const std::size_t part = parts.size() - 1 - i;
            parts[part] = none();
            for (std::size_t at = part * k_chunk; at < std::min(count, (part + 1) * k_chunk); ++at)
                add_size(first + static_cast<double>(at) * step, parts[part]);
            progress.add(std::min(count - part * k_chunk, k_chunk));
        });
        Sums sum = none();
        for (const Sums& part : parts) add(sum, part, 1);
        return sum;
    }

    void add_size(double log_diameter, Sums& sums) const {
        const double diameter = std::exp(log_diameter);
        const double weight = sizes_(log_diameter) / VolumeBySize::volume(diameter);
        if (weight == 0) return;
        MieSphere sphere{wave_number_ * diameter / 2, sphere_index_, {}};
        if (coat_thickness_ > 0 && 2 * coat_thickness_ < diameter) {
            sphere.core =
                MieSphere::Core{wave_number_ * (diameter / 2 - coat_thickness_), sphere_index_};
            sphere.index = coat_index_;
        } else if (coat_thickness_ > 0) {
            sphere.index = coat_index_;
        }
        const MieScattering mie(sphere);
        const double area = weight * std::numbers::pi / 4 * diameter * diameter;
        sums.scattering += area * mie.scattering_efficiency();
        // Rounding would give non-absorbing particles a small absorption.
        if (sphere_index_.imag() > 0 || coat_index_.imag() > 0)
            sums.absorption +=
                area * std::max(0.0, mie.extinction_efficiency() - mie.scattering_efficiency());
        mie.add_intensity(weight / (wave_number_ * wave_number_), cosines_, sums.phase);
    }

    static bool agree(const Sums& coarse, const Sums& fine) {
        const auto differs = [](double a, double b, double by) {
            return std::abs(a - b) > by * std::abs(b);
        };
        constexpr double k_coefficient = 1e-4, k_phase = 0.02;
        if (differs(coarse.scattering, fine.scattering, k_coefficient)) return false;
        if (differs(coarse.absorption, fine.absorption, k_coefficient)) return false;
        double squares = 0;
        for (std::size_t i = 0; i < fine.phase.size(); ++i) {
            const double relative = coarse.phase[i] / fine.phase[i] - 1;
            squares += relative * relative;
        }
        return squares <= k_phase * k_phase * static_cast<double>(fine.phase.size());
    }

    VolumeBySize sizes_;
    double wave_number_;  // in the water [1/m]
    std::complex<double> sphere_index_, coat_index_;
    double coat_thickness_ = 0;
    std::vector<double> angles_, cosines_;
};

SpeciesOptics compute(const SpeciesDesc& species, double wavelength_nm, double n_water,
                      const ProgressCallback& progress) {
    const SizeAverage average(species, wavelength_nm, n_water);
    const std::string key = average.text();
    Sums sums;
    if (auto kept = kept_results(key, 2 + average.angles().size())) {
        sums = {(*kept)[0], (*kept)[1], {kept->begin() + 2, kept->end()}};
    } else {
        sums = average.converged(progress);
        std::vector<double> results{sums.scattering, sums.absorption};
        results.insert(results.end(), sums.phase.begin(), sums.phase.end());
        keep_results(key, results);
    }
    constexpr double k_ppm = 1e-6;
    return {k_ppm * sums.absorption, k_ppm * sums.scattering,
            std::make_shared<SpeciesPhase>(table_with_middles(average.angles(), sums.phase),
                                           species.name)};
}

/// The results of this process, of which every image of a run needs the same.
class KeptOptics {
  public:
    SpeciesOptics of(const SpeciesDesc& species, double wavelength_nm, double n_water,
                     const ProgressCallback& progress) {
        const auto is_it = [&](const Entry& entry) {
            return entry.wavelength_nm == wavelength_nm && entry.n_water == n_water &&
                   entry.species == species && entry.files.are_current();
        };
        {
            const std::scoped_lock lock(mutex_);
            if (const auto found = std::ranges::find_if(entries_, is_it); found != entries_.end())
                return found->optics;
        }
        FileStamps files(files_of(species));
        SpeciesOptics optics = compute(species, wavelength_nm, n_water, progress);
        const std::scoped_lock lock(mutex_);
        constexpr std::size_t k_max_entries = 4096;  // of 20 kB each
        if (entries_.size() >= k_max_entries) entries_.clear();
        entries_.push_back({species, wavelength_nm, n_water, std::move(files), optics});
        return optics;
    }

  private:
    struct Entry {
        SpeciesDesc species;
        double wavelength_nm, n_water;
        FileStamps files;
        SpeciesOptics optics;
    };

    std::mutex mutex_;
    std::vector<Entry> entries_;
};

SpeciesOptics measured_optics(const SpeciesDesc& species, double wavelength_nm, double salinity) {
    const MeasuredVsfDesc& desc = *species.vsf;
    SpeciesOptics optics;
    optics.absorption = desc.absorption;
    if (!desc.absorption_file.empty())
        optics.absorption = read_csv_file(desc.absorption_file, species.where)
                                .curve("wavelength_nm", "absorption")
                                .value(wavelength_nm);
    if (!(optics.absorption >= 0))
        throw InputError(
            fmt::format("{}: {} gives an absorption of {:g} 1/m at {:g} nm; give 0 "
                        "or more",
                        species.where, desc.absorption_file.filename().string(), optics.absorption,
                        wavelength_nm));
    const SampledCurve beta =
        particle_vsf(read_measured_vsf(species), species, wavelength_nm, salinity);
    try {
        const auto phase = std::make_shared<SpeciesPhase>(beta, species.name);
        optics.scattering = phase->table_integral();
        optics.phase = phase;
    } catch (const InputError& error) {
        throw InputError(fmt::format("{}: {}", species.where, error.what()));
    }
    return optics;
}

SpeciesOptics kopelevich_optics(const SpeciesDesc& species, double wavelength_nm,
                                bool mineral_absorption) {
    static const std::shared_ptr<const PhaseFunction> k_small = std::make_shared<KopelevichSmall>(),
                                                      k_large = std::make_shared<KopelevichLarge>();
    const bool is_small = *species.kopelevich == KopelevichClass::small;
    return {mineral_absorption ? *species.density * mineral_mass_absorption(wavelength_nm) : 0,
            is_small ? kopelevich_small_scattering(wavelength_nm)
                     : kopelevich_large_scattering(wavelength_nm),
            is_small ? k_small : k_large};
}

}  // namespace

std::vector<std::filesystem::path> files_of(const SpeciesDesc& species) {
    std::vector<std::filesystem::path> files;
    const auto add_file = [&](const std::filesystem::path& file) {
        if (!file.empty()) files.push_back(file);
    };
    add_file(species.sizes.file);
    add_file(species.index.file);
    if (species.coat) add_file(species.coat->index.file);
    if (species.vsf) {
        add_file(species.vsf->file);
        add_file(species.vsf->absorption_file);
    }
    return files;
}

SpeciesOptics species_optics(const SpeciesDesc& species, double wavelength_nm, double n_water,
                             const ProgressCallback& progress) {
    static KeptOptics kept;
    return kept.of(species, wavelength_nm, n_water, progress);
}

SpeciesOptics species_optics(const SpeciesDesc& species, double wavelength_nm,
                             const WaterDesc& water, const ProgressCallback& progress) {
    if (species.vsf) return measured_optics(species, wavelength_nm, water.salinity);
    if (species.kopelevich)
        return kopelevich_optics(species, wavelength_nm, water.mineral_absorption);
    return species_optics(species, wavelength_nm,
                          water_refractive_index(wavelength_nm, water.temperature, water.salinity),
                          progress);
}

double species_work(const SpeciesDesc& species, double wavelength_nm, const WaterDesc& water) {
    if (species.vsf || species.kopelevich) return 0;
    return SizeAverage(species, wavelength_nm,
                       water_refractive_index(wavelength_nm, water.temperature, water.salinity))
        .work();
}

std::vector<SpeciesDesc> all_species(const WaterDesc& water) {
    std::vector<SpeciesDesc> all = water.species;
    all.push_back(kopelevich_species(KopelevichClass::small, "small", water.where));
    all.push_back(kopelevich_species(KopelevichClass::large, "large", water.where));
    return all;
}

std::vector<double> measured_wavelengths(const SpeciesDesc& species) {
    return species.vsf ? read_measured_vsf(species).wavelengths_nm : std::vector<double>();
}

std::string unit_of(const SpeciesDesc& species) {
    return species.vsf ? "sample" : "ppm";
}

std::optional<std::string> sizes_warning(const SpeciesDesc& species) {
    constexpr double k_enough = 1e-3;
    const SizesDesc& sizes = species.sizes;
    if (species.vsf || species.kopelevich || sizes.type != SizesDesc::Type::lognormal ||
        sizes.greatest > 0)
        return std::nullopt;
    const auto [small, large] = VolumeBySize(species).left_out();
    std::string where;
    if (small > k_enough)
        where =
            fmt::format("{:.2g} % of its volume is in particles smaller than 10 nm", 100 * small);
    if (large > k_enough)
        where += fmt::format("{}{:.2g} % of its volume is in particles larger than 5 mm",
                             where.empty() ? "" : " and ", 100 * large);
    if (where.empty()) return std::nullopt;
    return fmt::format(
        "{}: its size distribution is cut off, as {}: concentrations by volume, mass and turbidity "
        "are those of the rest, those by number count all of them; give a median or a sigma that "
        "has fewer, or write diameter: [10 nm, 5 mm] where there are no others",
        species.where, where);
}

double concentration_of(const SpeciesDesc& species, const SpeciesAmount& amount,
                        const WaterDesc& water) {
    constexpr double k_ntu_nm = 550;
    switch (amount.unit) {
        case SpeciesAmount::Unit::grams:
            if (species.vsf) return amount.amount / species.vsf->sample->amount;
            return amount.amount / *species.density;  // g/cm^3 is 1 g/m^3 per ppm
        case SpeciesAmount::Unit::number:
            if (species.vsf) return amount.amount / species.vsf->sample->amount;
            return amount.amount * VolumeBySize(species).mean_volume() * 1e6;
        case SpeciesAmount::Unit::ntu: {
            const double b = species_optics(species, k_ntu_nm, water).scattering;
            if (!(b > 0))
                throw InputError(fmt::format(
                    "{}: does not scatter at 550 nm and has no turbidity; give another unit",
                    species.where));
            return amount.amount * species.ntu_scattering / b;
        }
        case SpeciesAmount::Unit::own:
            break;
    }
    return amount.amount;
}

}  // namespace uw
