#pragma once

#include <cstdint>
#include <vector>

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
    double evaluate(double psi) const;

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

    static double evaluate(const Segment& segment, double psi);
    std::size_t segment_of(double psi) const;

    std::vector<double> psi_;
    std::vector<Segment> segments_;
    // Segment that contains the lower edge of each bucket of angles; 32 buckets per octave, taken
    // from the number's leading bits, so that finding the bucket needs no logarithm.
    std::uint64_t first_key_ = 0;
    std::vector<std::uint32_t> bucket_;
};

}  // namespace uw
