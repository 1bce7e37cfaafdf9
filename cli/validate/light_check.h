#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/image/preview.h"

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

}  // namespace uw
