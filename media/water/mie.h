#pragma once

#include <complex>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace uw {

/// A sphere in water: its size and indices relative to those of the light around it. With a core
/// it is coated.
struct MieSphere {
    /// 2 pi r / lambda, with the wavelength in the water.
    double size_parameter = 0;
    /// Relative to the water's, n + i k: k >= 0 absorbs.
    std::complex<double> index{1, 0};
    struct Core {
        double size_parameter = 0;  // < that of the sphere
        std::complex<double> index{1, 0};
    };
    std::optional<Core> core;
};

/// Scattering of a plane wave by a sphere (Lorenz-Mie; coated: Aden and Kerker 1951).
///
/// The coefficients are computed from logarithmic derivatives (downward recurrence for the first
/// kind, upward for the third) and from ratios that stay finite (Yang 2003), so that neither size
/// (up to 1e5) nor absorption makes them overflow.
class MieScattering {
  public:
    explicit MieScattering(const MieSphere& sphere);

    /// Efficiencies: cross sections over the sphere's geometric one.
    double extinction_efficiency() const { return extinction_; }
    double scattering_efficiency() const { return scattering_; }
    /// Mean cosine of the scattering angle.
    double mean_cosine() const { return mean_cosine_; }

    /// Adds `weight` times (|S1|^2 + |S2|^2) / 2 for unpolarised light, at each cosine of the
    /// scattering angle, to `sum`: times 1 / k^2 it is the differential cross section, k being the
    /// wave number in the water.
    void add_intensity(double weight, std::span<const double> cosines, std::span<double> sum) const;

    /// S1 and S2 at a cosine of the scattering angle (Bohren and Huffman 1983, eq. 4.74).
    std::pair<std::complex<double>, std::complex<double>> amplitudes(double cosine) const;

  private:
    // (2n + 1) / (n (n + 1)) times a_n + b_n and a_n - b_n, from n = 1.
    std::vector<std::complex<double>> sums_, differences_;
    double extinction_ = 0, scattering_ = 0, mean_cosine_ = 0;
};

}  // namespace uw
