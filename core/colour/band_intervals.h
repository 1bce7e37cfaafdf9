#pragma once

#include <span>
#include <vector>

namespace uw {

/// The wavelength interval that a band represents [nm].
struct BandInterval {
    double begin = 0;
    double end = 0;

    double width() const { return end - begin; }
};

/// The interval of each band, in the order of `bands_nm`: from halfway to its lower neighbour to
/// halfway to its upper one; the first and last extend symmetrically about their bands. A single
/// band has width 0.
///
/// A quantity per band is its spectral density, averaged over the band's interval, times
/// mean_band_width: bands are treated as equally wide. Light with constant spectral density has the
/// same value in every band, wherever the bands lie; for evenly spaced bands, a value is the
/// integral over the interval (W/sr, W/m^2, ...).
std::vector<BandInterval> band_intervals(std::span<const double> bands_nm);

/// Mean width of the intervals [nm].
double mean_band_width(std::span<const BandInterval> intervals);

}  // namespace uw
