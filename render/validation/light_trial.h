#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>

#include "render/validation/validation.h"
#include "render/validation/validation_methods.h"

namespace uw {

/// The mean of independent estimates, and its standard error by their spread.
class LightMean {
  public:
    /// Adds a value by Welford's recurrence, which avoids cancellation.
    void add(double estimate) {
        ++count_;
        const double before = estimate - mean_;
        mean_ += before / static_cast<double>(count_);
        squares_ += before * (estimate - mean_);
    }
    double mean() const { return mean_; }
    /// The standard error of the mean; 0 for fewer than two estimates.
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

/// The radiance of scattered light [W m^-2 sr^-1] at `distance` [m] and `angle` [degrees], as
/// LampTableRow has them, by light paths: the mean of 32 rounds.
LightMean scattered_around_lamp(double distance, double angle);

/// As validate_by_table in validation.h, with these rows.
LightValidation validate_by_table(std::span<const LampTableRow> table,
                                  const ValidationOptions& options);

/// As validate_all_light in validation.h, but of the fast form as `under_test` changes it.
LightValidation validate_all_light(const ImageScene& scene, const std::string& name,
                                   const ValidationOptions& options,
                                   const TransportChange& under_test);

}  // namespace uw
