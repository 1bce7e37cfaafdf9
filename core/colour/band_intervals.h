#pragma once

#include <span>
#include <vector>

namespace uw {

/// The wavelengths that a band stands for [nm].
struct BandInterval {
    double begin = 0;
    double end = 0;

    double width() const { return end - begin; }
};

/// The interval of each band, in the order of `bands_nm`: from halfway to its lower neighbour to
/// halfway to its upper one; the first and last reach as far out as in. A single band has width 0.
///
/// A quantity per band is its spectral density, averaged over the band's interval, times
/// mean_band_width: bands count as equally wide. Light of the same density everywhere has the same
/// value in every band, wherever the bands lie; of evenly spaced bands a value is what the interval
/// holds (W/sr, W/m^2, ...).
std::vector<BandInterval> band_intervals(std::span<const double> bands_nm);

/// Mean width of the intervals [nm].
double mean_band_width(std::span<const BandInterval> intervals);

}  // namespace uw
