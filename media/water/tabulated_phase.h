#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/csv_table.h"
#include "core/light/phase_function.h"

namespace uw {

/// A non-negative continuous function of an angle in [0, pi], given by its values at knots and an
/// interpolation law for each segment between neighbours. One evaluation costs a table look-up and
/// at most one log and one exp.
class PiecewiseFunction {
  public:
    enum class Law : std::uint8_t {
        linear,       // f linear in psi
        exponential,  // ln f linear in psi; needs f > 0 at both ends
        power,        // ln f linear in ln psi; needs f > 0 and psi > 0 at both ends
    };

    /// `psi` [rad] ascends strictly from exactly 0 to pi; `value` has the same length, `laws` one
    /// fewer.
    PiecewiseFunction(std::vector<double> psi, const std::vector<double>& value,
                      const std::vector<Law>& laws);

    /// f at `psi` [rad]; angles outside [0, pi] (rounding) are clamped.
    double eval(double psi) const;

    /// 2 pi int f sin(psi) dpsi between two knots (indices), to about 1e-13 relative.
    double integral(std::size_t first_knot, std::size_t last_knot) const;

    /// Multiplies f by `factor` > 0.
    void scale(double factor);

    const std::vector<double>& knots() const { return psi_; }

  private:
    struct Segment {
        Law law;
        double x, y, m;  // f or ln f = y + m (psi or ln psi - x); x at the segment's start
    };

    static double eval(const Segment& segment, double psi);
    std::size_t segment_of(double psi) const;

    std::vector<double> psi_;
    std::vector<Segment> segments_;
    // Segment that contains the lower edge of each bucket of angles; 32 buckets per octave, taken
    // from the number's leading bits, so that finding the bucket needs no logarithm.
    std::uint64_t first_key_ = 0;
    std::vector<std::uint32_t> bucket_;
};

/// A phase function from a table of angles, renormalised to 2 pi int p sin(psi) dpsi = 1.
///
/// Between angles: ln p linear in ln psi; p linear in psi where an end is 0 (an angle of 0, or a
/// value of 0). Below the first angle, if it is not 0, the power law of the first segment is
/// extrapolated (its exponent clamped to [-1.9, 0], so that the integral stays finite) down to
/// `k_min_angle`, and constant from there to 0. It is also constant beyond the last angle.
class TabulatedPhase : public PhaseFunction {
  public:
    /// 1e-6 rad (0.2 arc seconds): far below any pixel, and below the diffraction angle of a
    /// particle half a metre in size, so that no real water has a sharper peak.
    static constexpr double k_min_angle = 1e-6;

    /// `table`: angles in degrees, in [0, 180], and values >= 0 up to a common factor.
    /// `low_exponent`, in [-1.9, 0], overrides the one derived from the first segment. Fewer than
    /// two angles, an angle out of range, or values that are negative or all 0: InputError starting
    /// with `name`.
    TabulatedPhase(const SampledCurve& table, const std::string& name,
                   std::optional<double> low_exponent = std::nullopt);

    using PhaseFunction::eval;
    void eval(std::span<const double> psi, std::span<double> p) const override;

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
