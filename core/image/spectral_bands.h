#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/base/csv_table.h"
#include "core/scene/lamp_desc.h"
#include "core/scene/scene_context.h"

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

/// CIE 1931 tristimulus values, or values of the colour matching functions.
struct Xyz {
    double x = 0;
    double y = 0;
    double z = 0;
};

/// The colour matching functions of the CIE 1931 2 degree standard observer, dimensionless,
/// interpolated linearly in the 5 nm table; zero outside 360..830 nm.
/// Source: CIE 015 tables as in colour-science/colour, colour/colorimetry/datasets/cmfs.py (BSD-3).
Xyz cie1931_matching_functions(double wavelength_nm);

/// Their means over a wavelength interval, `begin_nm` < `end_nm`.
Xyz mean_matching_functions(double begin_nm, double end_nm);

/// A relative spectral distribution.
struct LampSpectrum {
    SampledCurve density;  // per nm; zero outside the curve
    double total = 0;      // its integral over all wavelengths, including those beyond the curve
};

/// The spectrum that `desc` names:
/// - flat: the same per nm from 380 to 780 nm (equal energy, CIE E), none outside;
/// - d65, led: tables of the CIE, 5 nm;
/// - blackbody: Planck's law; its total counts all wavelengths, most of them infrared;
/// - file: a table, linear in between.
/// Throws InputError if there is no such spectrum, IoError for a file that cannot be read.
LampSpectrum make_lamp_spectrum(const LampSpectrumDesc& desc);

/// Integral of `curve` from `begin` to `end`; outside its samples it is 0.
double integral(const SampledCurve& curve, double begin, double end);

/// Luminous efficacy of radiation, 683 int V S / int S [lm/W], with V = y of CIE 1931.
double luminous_efficacy(const LampSpectrum& spectrum);

/// Distributes `total` (in W or W/sr, over all wavelengths) over the bands according to this
/// spectrum; see band_intervals.
PerBand band_values(const LampSpectrum& spectrum, double total,
                    std::span<const BandInterval> intervals);
}  // namespace uw
