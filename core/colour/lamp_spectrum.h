#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/colour/band_intervals.h"
#include "core/scene/lamp_spectrum_desc.h"
#include "core/scene/per_band.h"
#include "core/tables/sampled_curve.h"

namespace uw {

/// Luminous efficacy of light at 555 nm, by which the SI defines the candela [lm/W].
inline constexpr double k_lumens_per_watt = 683;

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
