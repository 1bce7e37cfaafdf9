#pragma once

#include <cstddef>
#include <vector>

#include "core/base/spectrum.h"

namespace uw {

/// Pixels darker than this fraction of the mean are compared with that, where nothing else is said.
inline constexpr double k_dark = 0.01;

/// The mean of one band.
double mean_over_pixels(const std::vector<Spectrum>& image, std::size_t band);

/// The largest difference of `a` relative to `b` over the pixels that `counted` marks; those darker
/// than the fraction `dark` of b's mean count as that bright.
double largest_difference(const std::vector<Spectrum>& a, const std::vector<Spectrum>& b,
                          const std::vector<char>& counted, std::size_t band, double dark);

/// The RMS of the differences, relative to b's mean.
double rms_difference(const std::vector<Spectrum>& a, const std::vector<Spectrum>& b,
                      std::size_t band);

}  // namespace uw
