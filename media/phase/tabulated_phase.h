#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/optics/phase_function.h"
#include "core/tables/sampled_curve.h"
#include "media/phase/piecewise_function.h"

namespace uw {

/// A phase function from a table of angles, renormalised to 2 pi int p sin(psi) dpsi = 1.
///
/// Between angles: ln p linear in ln psi; p linear in psi where an end is 0 (an angle of 0, or a
/// value of 0). Below the first angle, if it is not 0, the power law of the first segment is
/// extrapolated (its exponent clamped to [-1.9, 0], so that the integral stays finite) down to
/// `k_smallest_angle`, and held constant from there to 0. Beyond the last angle its value is held.
class TabulatedPhase : public PhaseFunction {
  public:
    /// 1e-6 rad: see FournierForand::k_smallest_angle.
    static constexpr double k_smallest_angle = 1e-6;

    /// `table`: angles in degrees, in [0, 180], and values >= 0 up to a common factor.
    /// `low_exponent`, in [-1.9, 0], overrides the one derived from the first segment. Fewer than
    /// two angles, an angle out of range, or values that are negative or all 0: InputError starting
    /// with `name`.
    TabulatedPhase(const SampledCurve& table, const std::string& name,
                   std::optional<double> low_exponent = std::nullopt);

    using PhaseFunction::evaluate;
    void evaluate(std::span<const double> psi, std::span<double> p) const override;

    /// Every angle of the table, and splits at ratios of 4 where the table is extrapolated to 0.
    std::vector<double> breakpoints() const override;

    std::string description() const override { return name_; }

    /// 2 pi int sin(psi) dpsi of the table as given, before renormalising: 1 if it was a phase
    /// function, b if it was a volume scattering function.
    double table_integral() const { return table_integral_; }

    /// Fraction of the scattering that lies outside the table's angles.
    double extrapolated_fraction() const { return extrapolated_fraction_; }

  protected:
    /// For tables with their own interpolation: takes `f` as it is.
    TabulatedPhase(PiecewiseFunction f, std::string name);

  private:
    void normalise();

    std::string name_;
    PiecewiseFunction f_;
    double table_integral_ = 0;
    double extrapolated_fraction_ = 0;
};

/// Reads a phase function from CSV text with columns angle_deg and phase; `name` (a file name)
/// begins every message. InputError as CsvTable and TabulatedPhase.
TabulatedPhase read_phase_table(std::string_view text, const std::string& name);

/// Petzold's average particle phase function (Mobley, Gentili and Stavn 1993, table 2), continued
/// below 0.1 degrees as psi^-1.346. With log-log interpolation its table integrates to 0.9926; here
/// it is normalised to 1.
class PetzoldAverage final : public TabulatedPhase {
  public:
    PetzoldAverage();
};

/// Small particles of Kopelevich's model (1983; Mobley 1994, table 3.13): ln beta linear in psi.
class KopelevichSmall final : public TabulatedPhase {
  public:
    KopelevichSmall();
};

/// Large particles of Kopelevich's model: ln beta linear in ln psi, and beta linear in psi from
/// 0 to 0.5 degrees. A quarter of its scattering lies below 1 degree.
class KopelevichLarge final : public TabulatedPhase {
  public:
    KopelevichLarge();
};

}  // namespace uw
