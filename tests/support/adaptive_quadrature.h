#pragma once

#include <cmath>
#include <functional>

namespace uw::test {

/// Adaptive Simpson quadrature of `f` over [a, b] to an absolute error of about `tolerance`; the
/// independent check of every integral in the program.
class AdaptiveQuadrature {
  public:
    using Function = std::function<double(double)>;

    static double integrate(const Function& f, double a, double b, double tolerance) {
        const double fa = f(a), fb = f(b), fm = f(0.5 * (a + b));
        return refine(f, a, b, fa, fm, fb, simpson(a, b, fa, fm, fb), tolerance, 40);
    }

  private:
    static double simpson(double a, double b, double fa, double fm, double fb) {
        return (b - a) / 6 * (fa + 4 * fm + fb);
    }
    static double refine(const Function& f, double a, double b, double fa, double fm, double fb,
                         double whole, double tolerance, int depth) {
        const double m = 0.5 * (a + b);
        const double fl = f(0.5 * (a + m)), fr = f(0.5 * (m + b));
        const double left = simpson(a, m, fa, fl, fm), right = simpson(m, b, fm, fr, fb);
        const double change = left + right - whole;
        if (depth <= 0 || std::abs(change) <= 15 * tolerance) return left + right + change / 15;
        return refine(f, a, m, fa, fl, fm, left, 0.5 * tolerance, depth - 1) +
               refine(f, m, b, fm, fr, fb, right, 0.5 * tolerance, depth - 1);
    }
};

}  // namespace uw::test
