#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/base/csv_table.h"
#include "core/base/spectrum.h"
#include "core/base/vector_math.h"
#include "core/scene/sky_desc.h"

namespace uw {

struct SkyQuadrature;

/// The relative spectral power per nm of daylight of the chromaticity (x, y), CIE 1931: S = S0 + M1
/// S1 + M2 S2 with the CIE's components, 300 to 830 nm, and the factors M1 and M2 of CIE 15 (Judd,
/// MacAdam and Wyszecki 1964). Far from any daylight it may be negative.
SampledCurve daylight_spectrum(double x, double y);

/// A rotation whose columns are east, north and up in the world: it maps sky space, in which
/// directions towards the sky are given (x east, y north, z up), to the world. `up` is unit; see
/// SkyDesc::north. Throws InputError "<where>: ..." if north is vertical.
Matrix3 world_from_sky(const Vector3& up, const std::optional<Vector3>& north,
                       const SourceLocation& where);

/// One of the directions that represent a sky.
struct SkyDirection {
    Vector3 towards;         ///< the sky, in the air, sky space, unit
    double solid_angle = 0;  ///< of the part of the sky that it represents [sr]
    Spectrum radiance;       ///< [W m^-2 sr^-1]

    /// Its irradiance on a plane that faces it, in the air [W/m^2].
    Spectrum normal_irradiance() const { return solid_angle * radiance; }
};

/// The sky's radiance by direction, above a horizontal water surface, in the air. It does not
/// contain the sun's disc.
///
/// With theta the angle from the zenith, up to a factor that follows from the irradiance given:
///
/// - uniform: L = E / pi.
/// - overcast: L = L_z (1 + 2 cos theta) / 3 with E = 7 pi L_z / 9 (Moon and Spencer 1942; CIE S
///   011/E:2003, type 16).
/// - clear: Preetham, Shirley and Smits 1999, "A practical analytic model for daylight", appendix
///   A.2. With gamma the angle from the sun, luminance Y and chromaticities x and y each are
///       zenith value F(theta, gamma) / F(0, theta_sun),
///       F = (1 + A e^(B / cos theta)) (1 + C e^(D gamma) + E cos^2 gamma),
///   with coefficients linear in the turbidity. The spectrum is daylight_spectrum(x, y), of the
///   luminance Y by 683 lm/W, averaged over each band's interval (core/image/spectral_bands.h) and
///   never negative. Irradiance or lux scale it, per band or as a whole.
/// - panorama: the image's R, G and B as reflectances become bands (ReflectanceBands), bilinear
///   between the centres of pixels; values below 0 count as 0. Without an irradiance they are W
///   m^-2 sr^-1. A sun in the image is part of the sky.
///
/// Immutable, and safe to use from several threads.
class Sky {
  public:
    /// `up`: out of the water, world, unit. Throws InputError for a sun below the horizon, for what
    /// needs a spectrum if there is a single band, whose width is undefined, for a spectrum without
    /// light in any band, and for an image that is no panorama of finite values; IoError for a file
    /// that cannot be read.
    Sky(const SkyDesc& desc, const Vector3& up, std::span<const double> bands_nm);

    /// Maps sky space to the world; orthonormal.
    const Matrix3& world_from_sky() const { return world_from_sky_; }
    /// The direction to the sun's centre, sky space, unit; none if the model has no sun.
    const std::optional<Vector3>& sun() const { return sun_; }

    /// Radiance from the direction `towards` the sky, sky space, unit [W m^-2 sr^-1]; none below
    /// the horizon.
    Spectrum radiance(const Vector3& towards) const;

    /// Plane irradiance of a horizontal surface in the air [W/m^2].
    Spectrum irradiance() const;

    /// Divides the sky into `count` parts, 1 to 1024, of about equal irradiance below flat water,
    /// each with a direction that represents it; none for a sky without light, and fewer where the
    /// light comes from fewer parts than that. They are the same in every call, and cover 2 pi sr
    /// where no part of the sky is dark.
    ///
    /// `water_index` is the water's refractive index, which leaves out what flat water reflects. A
    /// direction's radiance is such that the N of them, refracted by flat water and dimmed by
    /// Fresnel's transmittance T for unpolarised light, give the sky's own plane irradiance below
    /// it
    ///     E = int L T cos theta dOmega
    /// exactly, in each band, and each part gives its own. Its direction is chosen so that the
    /// scalar irradiance of its part, normalised by the total in each band and summed, is exact,
    /// too:
    ///     E_0 = int L T cos theta / cos theta_w dOmega, sin theta_w = sin theta / n.
    /// An index of 1 gives both in the air.
    std::vector<SkyDirection> directions(int count, double water_index) const;

    /// The lattice by which its integrals are taken, with its radiance there.
    const std::shared_ptr<const SkyQuadrature>& quadrature() const { return quadrature_; }

    class Distribution;

  private:
    Matrix3 world_from_sky_{1.0};
    std::optional<Vector3> sun_;
    std::size_t bands_ = 0;
    std::shared_ptr<const Distribution> distribution_;
    std::shared_ptr<const SkyQuadrature> quadrature_;
    Spectrum scale_;
};

/// Fresnel's transmittance for unpolarised light from the air into water of index `n`, the fraction
/// of energy that enters, by the cosine of the angle of incidence, 0..1; 0 at grazing incidence
/// unless n is 1.
double transmittance_into_water(double cosine, double n);

}  // namespace uw
