#pragma once

namespace uw {

/// Junge's hyperbolic size distribution: the number of particles with diameters from D to D + dD is
/// proportional to D^-exponent dD between a least and a greatest diameter (Junge 1963; Bader 1970;
/// of particles in the sea, exponents of 3 to 5). Diameters are those of spheres [m]. In all
/// functions least <= a < b <= greatest.
class JungeSizes {
  public:
    /// 0 < least < greatest.
    JungeSizes(double exponent, double least, double greatest);

    double least() const { return least_; }
    double greatest() const { return greatest_; }

    /// The share of all particles, by number, with diameters from `a` to `b`.
    double share(double a, double b) const;
    /// The diameter below which a share `u` of those from `a` to `b` is, 0 <= u <= 1.
    double quantile(double u, double a, double b) const;
    /// The mean cross section, pi D^2 / 4, of those from `a` to `b` [m^2].
    double mean_area(double a, double b) const;

  private:
    double exponent_, least_, greatest_;
};

}  // namespace uw
