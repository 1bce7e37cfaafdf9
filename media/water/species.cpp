#include "media/water/species.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <mutex>
#include <numbers>
#include <utility>
#include <vector>

#include "core/base/csv_table.h"
#include "core/base/input_files.h"
#include "core/base/parallel.h"
#include "media/water/mie.h"

namespace uw {

namespace {

/// Diameters, and the volume of particles per interval of their logarithm, which integrates to 1.
class VolumeBySize {
  public:
    explicit VolumeBySize(const SpeciesDesc& species) : sizes_(species.sizes) {
        if (sizes_.type == SizesDesc::Type::table) read_table(species);
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
    }

    double first() const { return first_; }
    double last() const { return last_; }
    double greatest() const { return sizes_.greatest; }
    double operator()(double log_diameter) const { return factor_ * value(log_diameter); }
    double mean_volume() const { return mean_volume_; }  // of a particle [m^3]

    static double volume(double diameter) {
        return std::numbers::pi / 6 * diameter * diameter * diameter;
    }

  private:
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
    if (index.file.empty()) return {index.n, index.k};
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

/// Scattering angles [rad], fine where spheres up to `greatest_x` have their forward peak.
std::vector<double> scattering_angles(double greatest_x) {
    std::vector<double> angles{0};
    constexpr int k_per_octave = 28;
    constexpr double k_linear = std::numbers::pi / 180, k_widest = 30 * std::numbers::pi / 180;
    for (double psi = 0.3 / std::max(greatest_x, 1.0); psi < k_widest;
         psi *= std::exp2(1.0 / k_per_octave))
        angles.push_back(psi);
    const auto rest = static_cast<int>(std::ceil((std::numbers::pi - k_widest) / k_linear));
    for (int i = 0; i <= rest; ++i)
        angles.push_back(i == rest ? std::numbers::pi : k_widest + i * k_linear);
    return angles;
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

    /// The mean of midpoints of intervals, of which there are more and more.
    Sums converged() const {
        constexpr std::size_t k_first = 128, k_most = 2048;
        Sums coarse = midpoints(k_first);
        for (std::size_t count = 2 * k_first;; count *= 2) {
            Sums fine = midpoints(count);
            if (agree(coarse, fine) || count == k_most) return fine;
            coarse = std::move(fine);
        }
    }

  private:
    Sums midpoints(std::size_t count) const {
        constexpr std::size_t k_chunk = 16;
        const double step = (sizes_.last() - sizes_.first()) / static_cast<double>(count);
        std::vector<Sums> parts((count + k_chunk - 1) / k_chunk);
        parallel_for(parts.size(), [&](std::size_t i) {
            // The largest, which take longest, first.
            const std::size_t part = parts.size() - 1 - i;
            parts[part].phase.assign(angles_.size(), 0);
            for (std::size_t at = part * k_chunk; at < std::min(count, (part + 1) * k_chunk); ++at)
                add_size(sizes_.first() + (static_cast<double>(at) + 0.5) * step, parts[part]);
        });
        Sums sum{0, 0, std::vector<double>(angles_.size(), 0)};
        for (const Sums& part : parts) add(sum, part, step);
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
        // Rounding makes a little of what does not absorb.
        if (fine.absorption > 1e-9 * fine.scattering &&
            differs(coarse.absorption, fine.absorption, k_coefficient))
            return false;
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

SpeciesOptics compute(const SpeciesDesc& species, double wavelength_nm, double n_water) {
    const SizeAverage average(species, wavelength_nm, n_water);
    const Sums sums = average.converged();
    constexpr double k_ppm = 1e-6;
    SampledCurve curve;
    for (const double psi : average.angles())
        curve.x.push_back(psi == std::numbers::pi ? 180 : psi * (180 / std::numbers::pi));
    curve.y = sums.phase;
    return {k_ppm * sums.absorption, k_ppm * sums.scattering,
            std::make_shared<SpeciesPhase>(curve, species.name)};
}

/// The results of this process, of which every image of a run needs the same.
class KeptOptics {
  public:
    SpeciesOptics of(const SpeciesDesc& species, double wavelength_nm, double n_water) {
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
        SpeciesOptics optics = compute(species, wavelength_nm, n_water);
        const std::scoped_lock lock(mutex_);
        constexpr std::size_t k_most = 4096;  // of 20 kB each
        if (entries_.size() >= k_most) entries_.clear();
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

}  // namespace

std::vector<std::filesystem::path> files_of(const SpeciesDesc& species) {
    std::vector<std::filesystem::path> files;
    const auto add_file = [&](const std::filesystem::path& file) {
        if (!file.empty()) files.push_back(file);
    };
    add_file(species.sizes.file);
    add_file(species.index.file);
    if (species.coat) add_file(species.coat->index.file);
    return files;
}

SpeciesOptics species_optics(const SpeciesDesc& species, double wavelength_nm, double n_water) {
    static KeptOptics kept;
    return kept.of(species, wavelength_nm, n_water);
}

double parts_per_million(const SpeciesDesc& species, const SpeciesAmount& amount) {
    switch (amount.unit) {
        case SpeciesAmount::Unit::grams:
            return amount.amount / *species.density;  // g/cm^3 is 1 g/m^3 per ppm
        case SpeciesAmount::Unit::number:
            return amount.amount * VolumeBySize(species).mean_volume() * 1e6;
        case SpeciesAmount::Unit::ppm:
            break;
    }
    return amount.amount;
}

}  // namespace uw
