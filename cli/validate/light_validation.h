#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "cli/validate/validation.h"
#include "core/image/pixel_image.h"

namespace uw {

/// How far single pixels are apart, over a number of them.
struct PixelSpread {
    std::size_t pixels = 0;
    double rms = 0;              // of the image's mean
    double rms_in_errors = 0;    // each in units of its stated standard error
    double worst_in_errors = 0;  // the largest of these
};

/// How two estimates of some light differ, at least one of which has a standard error. Relative to
/// the mean of all light in the band.
struct LightCheck {
    /// A deviation beyond so many standard errors is a fault; and so is noise of single pixels of
    /// so many times the stated error.
    static constexpr double k_most_errors = 4, k_most_noise = 2;

    std::string left, right;
    std::string light;      // which: "multiple.volume, 540 nm"
    double deviation = 0;   // of the left's mean from the right's
    double error = 0;       // standard error of that
    double most_error = 0;  // beyond which the comparison says nothing, and fails
    std::optional<PixelSpread> spread{};

    double deviation_in_errors() const;
    bool passed() const;
};

/// The mean radiance of an image, per band, by the way that the light took [W m^-2 sr^-1].
struct LightParts {
    static constexpr std::array<const char*, 4> k_names{"direct", "backscatter", "multiple.volume",
                                                        "multiple.surface"};
    std::array<double, 4> means{};

    double all() const;
    /// Of part k_names[part] in all light, 0 without any.
    double share(std::size_t part) const;
    /// All light over that of single scattering; 0 without that.
    double ratio() const;
};

/// The results of what is compared in units of standard errors.
struct LightValidation {
    std::string name;
    std::vector<std::string> notes;  // a line each
    std::vector<LightCheck> checks;
    std::vector<double> bands_nm;
    std::vector<LightParts> parts;  // per band; may be empty
    std::vector<std::pair<std::string, Preview>> pictures;
    double seconds = 0;

    bool passed() const;
};

/// The mean of independent estimates, and its standard error by their spread.
class LightMean {
  public:
    /// By Welford's recurrence: means that differ little keep their digits.
    void add(double estimate) {
        ++count_;
        const double before = estimate - mean_;
        mean_ += before / static_cast<double>(count_);
        squares_ += before * (estimate - mean_);
    }
    double mean() const { return mean_; }
    /// Of the mean; 0 for fewer than two estimates.
    double error() const {
        if (count_ < 2) return 0;
        return std::sqrt(squares_ / static_cast<double>(count_ * (count_ - 1)));
    }

  private:
    std::size_t count_ = 0;
    double mean_ = 0, squares_ = 0;
};

/// Radiance in an infinite uniform medium with a point lamp of 1 W/sr: c = 1/m, albedo 0.8, phase
/// function of Henyey and Greenstein with g = 0.9. Light that was not scattered is left out.
struct LampTableRow {
    double distance = 0;             // from the lamp [m]
    double angle = 0;                // between the viewing direction and that to the lamp [degrees]
    std::array<double, 4> orders{};  // scattered once to four times [W m^-2 sr^-1]
    double total = 0;                // scattered any number of times
};

/// Some rows of tests/data/multiple/point_lamp_hg09_albedo08_radiance.csv: successive orders by
/// quadrature, converged to 1e-6.
std::span<const LampTableRow> lamp_table();

/// Compares light paths with `table`, order by order. Throws Interrupted.
LightValidation validate_by_table(std::span<const LampTableRow> table,
                                  const ValidationOptions& options);

/// Compares the fast form of multiple scattering, an image of integrator volume, with unbiased
/// light paths (integrator path) at pixels drawn at random all over the image: the parts
/// multiple.volume and multiple.surface, and their sum, in units of both standard errors. The image
/// is that of `scene` with at most ValidationOptions::longest_side_of_all_light pixels a side.
/// Throws InputError, and Interrupted.
LightValidation validate_all_light(const ImageScene& scene, const std::string& name,
                                   const ValidationOptions& options);

}  // namespace uw
