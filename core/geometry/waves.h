#pragma once

#include <memory>
#include <optional>
#include <string>

#include "core/base/vector_math.h"
#include "core/scene/waves_desc.h"

namespace uw {

/// Standard gravity [m/s^2], and water's surface tension over its density at 20 degrees Celsius
/// (0.0728 N/m over 998 kg/m^3) [m^3/s^2].
inline constexpr double k_gravity = 9.80665, k_surface_tension = 7.29e-5;

/// The angular frequency of waves [rad/s] by their wave number k [rad/m]: omega^2 = (g k +
/// sigma/rho k^3) tanh(k depth) (Lamb 1932, articles 228 and 266). `depth` [m]; none: deep.
double wave_frequency(double wave_number, const std::optional<double>& depth);

/// Its derivative, the group velocity [m/s].
double wave_group_velocity(double wave_number, const std::optional<double>& depth);

/// Variance of heights per frequency [m^2 s], of waves from all directions, in deep water:
///
/// - Pierson and Moskowitz 1964: alpha g^2 omega^-5 exp(-0.74 (g / (U omega))^4), alpha = 0.0081,
/// by
///   the wind U 19.5 m above the water.
/// - JONSWAP (Hasselmann et al. 1973): alpha g^2 omega^-5 exp(-1.25 (omega_p / omega)^4) gamma^r,
///   r = exp(-(omega - omega_p)^2 / (2 s^2 omega_p^2)), s = 0.07 up to omega_p and 0.09 above it,
///   alpha = 0.076 (U^2 / (F g))^0.22 and omega_p = 22 (g^2 / (U F))^(1/3), by the fetch F and the
///   wind U 10 m above the water.
///
/// The wind at another height than given is that of a neutral boundary layer, 1 + sqrt(C) / 0.4
/// ln(z / 10 m) times that at 10 m, with the drag coefficient C = 0.0013.
double wave_spectrum(const WaveSpectrumDesc& desc, double angular_frequency);

/// The factor by which a finite depth reduces the spectrum (the TMA spectrum, Bouws et al. 1985;
/// Kitaigorodskii et al. 1975): tanh^2 kd / (1 + 2 kd / sinh 2 kd).
double shoaling_factor(double wave_number, double depth);

/// The fraction of the energy per angle [1/rad] at `angle` from the wind [rad]: cos^{2s}(angle / 2)
/// over its integral (Longuet-Higgins, Cartwright and Smith 1963).
double wave_spreading(double angle, double s);

/// Variances of the slope of a sea's surface, dimensionless.
struct SlopeVariance {
    double along = 0, across = 0;  ///< the wind, or u and v
    double covariance = 0;         ///< of both

    double total() const { return along + across; }
};

/// The slope variances of a clean sea, as measured from the sun's glitter (Cox and Munk 1954), by
/// the wind 12.5 m above the water [m/s]: 0.00316 U along it and 0.003 + 0.00192 U across. Their
/// fit to both together is 0.003 + 0.00512 U.
SlopeVariance cox_munk_slopes(double wind);

/// A point of the surface.
struct WavePoint {
    double height = 0;                ///< above the plane [m]
    double slope_u = 0, slope_v = 0;  ///< its derivatives

    /// Out of the water, in wave space, unit.
    Vector3 normal() const { return glm::normalize(Vector3{-slope_u, -slope_v, 1}); }
};

/// Statistics of a whole surface, by its components, or by the pixels of a height image.
struct WaveStatistics {
    double height_variance = 0;  ///< m_0 [m^2]
    SlopeVariance slopes;        ///< along u and v

    /// H_s = 4 sqrt(m_0) [m].
    double significant_height() const;
};

/// The surface of wavy water at one moment: a height above each place of a plane. Wave space has
/// its axes: x is u, y is v, z is up, out of the water, and 0 is calm water.
///
/// - A sum of sines: h = sum A cos(k.x - omega t + phase), omega by wave_frequency. With steepness
/// Q,
///   water that is at a when calm has moved to a - sum Q A k/|k| sin(k.a - omega t + phase), and
///   has the height sum A cos(...) there (Gerstner 1802 for one deep wave with Q = 1).
/// - A sea: the sum of waves with all wave vectors 2 pi (i, j) / tile that the resolution can hold,
///   |i|, |j| < resolution / 2, by FFT (Tessendorf 2001). Their amplitudes are those of the
///   spectrum, their phases random, each by the seed and (i, j) alone: a finer resolution adds
///   small waves to the same large ones. Between heights it is bicubic, by the derivatives of the
///   sum itself.
/// - An image, of linear floating-point values: bicubic, by central differences. The place (0, 0)
/// is its lower left corner.
///
/// Slopes are the derivatives of the heights, and continuous. Immutable, and safe to use from
/// several threads; the same for any number of them.
class WaterWaves {
  public:
    /// `time` [s]. Throws InputError for an image that is not one of floating-point numbers, for
    /// one with a height that is not finite, and for slopes above 30; IoError if it cannot be read.
    WaterWaves(const WavesDesc& desc, double time);

    WavePoint at(double u, double v) const;

    /// Bounds on all heights [m]; not necessarily tight.
    double lowest() const;
    double highest() const;
    /// An upper bound on all slopes, in any direction; not necessarily tight.
    double steepest() const;

    /// Distance along a ray [m] at which it first crosses the surface, from either side, to 1e-9 m
    /// or the rounding of its coordinates; none up to `farthest` [m]. `origin` [m] and `direction`,
    /// unit, in wave space. A ray that touches the surface from below by less than 1e-8 m may miss
    /// it.
    std::optional<double> intersect(const Point3& origin, const Vector3& direction,
                                    double farthest = 1e4) const;

    WaveStatistics statistics() const;

    class Shape;

  private:
    std::shared_ptr<const Shape> shape_;
};

/// One line that states which fraction of the slope variance that Cox and Munk measured at this
/// wind the waves contain, and the range of their wavelengths.
std::string compare_with_cox_munk(const WaveSpectrumDesc& desc, const WaterWaves& waves);

}  // namespace uw
