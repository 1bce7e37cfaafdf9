#pragma once

#include <concepts>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/base/ray.h"
#include "core/base/vector_math.h"
#include "core/light/image_profile.h"
#include "core/light/line_profile.h"
#include "core/light/photometric_files.h"
#include "core/light/profile_geometry.h"
#include "core/scene/lamp_desc.h"

namespace uw {

/// The profile of a lamp that is equally bright in all directions (IsALampProfile).
class IsotropicProfile {
  public:
    static constexpr std::string_view k_name = "isotropic";

    double relative_intensity(const Vector3& /*v*/) const { return 1.0; }
    double solid_angle() const { return 4.0 * std::numbers::pi; }
    std::optional<double> peak_candelas() const { return std::nullopt; }
    bool has_even_core() const { return true; }
    DirectionCone cone() const { return {}; }
    void append_breaks(const Ray& /*ray*/, const Interval& /*interval*/, const Point3& /*apex*/,
                       std::vector<double>& /*s*/) const {}

    friend bool operator==(const IsotropicProfile&, const IsotropicProfile&) = default;
};

inline IsotropicProfile make_profile(const IsotropicProfileDesc& /*desc*/,
                                     const LampPlacement& /*placement*/,
                                     std::vector<std::string>& /*warnings*/) {
    return {};
}

/// The profile of a spot: full in its core, 0 outside beam/2 + edge/2 of its axis, and with one of
/// several falloffs between (SpotProfileDesc::Falloff, IsALampProfile).
class SpotProfile {
  public:
    static constexpr std::string_view k_name = "spot";

    SpotProfile(const SpotProfileDesc& desc, const LampPlacement& placement);

    double relative_intensity(const Vector3& v) const;
    /// The relative intensity at an angle from its axis, 0 to pi [rad].
    double at(double angle) const;
    const Vector3& axis() const { return axis_; }
    double dark_angle() const { return dark_angle_; }
    double full_angle() const { return full_angle_; }
    /// The same profile, but with an edge of a few microradians if it has none.
    SpotProfile with_an_edge() const;
    double solid_angle() const;
    std::optional<double> peak_candelas() const { return std::nullopt; }
    bool has_even_core() const { return falloff_ != SpotProfileDesc::Falloff::blender_3_4; }
    DirectionCone cone() const { return {axis_, cos_dark_}; }
    void append_breaks(const Ray& ray, const Interval& interval, const Point3& apex,
                       std::vector<double>& s) const;

    friend bool operator==(const SpotProfile&, const SpotProfile&) = default;

  private:
    double of_cosine(double cosine) const;

    Vector3 axis_;
    SpotProfileDesc::Falloff falloff_;
    double dark_angle_, cos_dark_;    // the spot is dark outside this angle [rad]
    double full_angle_, cos_full_;    // and shines fully inside this one
    std::vector<double> core_cones_;  // cosines at which the core has breaks, its edge included
};

inline SpotProfile make_profile(const SpotProfileDesc& desc, const LampPlacement& placement,
                                std::vector<std::string>& /*warnings*/) {
    return {desc, placement};
}

/// The profile of a spot at a point that represents a part of a luminous surface, or of a sphere
/// (IsALampProfile): its edge is as soft as the part is wide. With the sharp profile, each point
/// would draw its own edge, and together they would draw steps, lobes and spikes instead of a soft
/// edge.
///
/// At a distance R, displacements of the source with a covariance C move the edge by angles with
/// the variance u^T C u / R^2, where u is the direction across the edge. The edge keeps its shape
/// (that of its falloff, if it has no width); its variance is the sum of its own and that one; and
/// it moves so that the flux at each distance remains that of the spot.
class SoftSpotProfile {
  public:
    static constexpr std::string_view k_name = SpotProfile::k_name;

    /// `offset`: from the point to the mean of its part [m]. `covariance`: of the part's points
    /// about that mean [m^2].
    SoftSpotProfile(const SpotProfile& spot, const Vector3& offset, const Matrix3& covariance);

    /// `v` leads from the point to where it is evaluated [m].
    double relative_intensity(const Vector3& v) const;
    double solid_angle() const { return spot_.solid_angle(); }
    std::optional<double> peak_candelas() const { return std::nullopt; }
    bool has_even_core() const { return false; }
    /// All directions: the middle of the part lies beside the point, and the light close to it
    /// anywhere around it.
    DirectionCone cone() const { return {spot_.axis(), -1}; }
    void append_breaks(const Ray& ray, const Interval& interval, const Point3& apex,
                       std::vector<double>& s) const;

    friend bool operator==(const SoftSpotProfile&, const SoftSpotProfile&) = default;

  private:
    struct Edge {
        double mean, deviation;  // of the angle at which the light ends
        double peak;             // the intensity inside it
    };
    /// The edge if displacements of the source move it by angles with this variance [rad^2].
    Edge edge(double displaced) const;

    SpotProfile spot_;
    Vector3 offset_;
    Matrix3 covariance_;
    // Moments of the angle at which the light ends, whose pdf is the negative slope of the profile.
    double mean_, deviation_;
    double dark_, full_;    // where the edge is dark and full, from the mean in standard deviations
    double max_displaced_;  // the greatest variance by which a part blurs the edge [rad^2]
    double cos_core_ = 2;   // at any distance it shines fully inside this angle; 2: nowhere
    double cos_dark_;       // and is dark outside this one
};

/// The profile cos^m of the angle from the axis, 1/2 at fwhm/2 and 0 behind the lamp
/// (IsALampProfile).
class CosineProfile {
  public:
    static constexpr std::string_view k_name = "cosine";

    CosineProfile(const CosineProfileDesc& desc, const LampPlacement& placement);

    double relative_intensity(const Vector3& v) const;
    double solid_angle() const;
    std::optional<double> peak_candelas() const { return std::nullopt; }
    bool has_even_core() const { return false; }
    /// All directions: restricting the search to a half-space would gain little.
    DirectionCone cone() const { return {axis_, -1}; }
    void append_breaks(const Ray& ray, const Interval& interval, const Point3& apex,
                       std::vector<double>& s) const;

    friend bool operator==(const CosineProfile&, const CosineProfile&) = default;

  private:
    Vector3 axis_;
    double exponent_;  // m
    // Ratios of the cosines at which it has breaks along a ray to the greatest one on it.
    std::vector<double> break_ratios_;
};

inline CosineProfile make_profile(const CosineProfileDesc& desc, const LampPlacement& placement,
                                  std::vector<std::string>& /*warnings*/) {
    return {desc, placement};
}

/// The profile of a luminaire given by its photometry, relative to its brightest direction
/// (IsALampProfile).
///
/// Azimuth 0 points towards the frame's x axis (its y axis if the lamp shines along x), projected
/// along the lamp's direction; `rotate` turns it about that direction, then `tilt` tilts the
/// luminaire's axis from that direction towards it. Azimuth 90 degrees lies anticlockwise of 0 seen
/// from behind the lamp, as in LM-63.
class IesProfile {
  public:
    static constexpr std::string_view k_name = "IES luminaire";

    /// `web` is the photometry of `desc.file`.
    IesProfile(const IesProfileDesc& desc, const LampPlacement& placement,
               std::shared_ptr<const PhotometricWeb> web);

    double relative_intensity(const Vector3& v) const;
    double solid_angle() const { return web_->flux() / web_->peak(); }
    std::optional<double> peak_candelas() const { return web_->peak(); }
    const Vector3& axis() const { return axis_; }
    bool has_even_core() const { return false; }
    DirectionCone cone() const { return {axis_, cos_dark_}; }
    void append_breaks(const Ray& ray, const Interval& interval, const Point3& apex,
                       std::vector<double>& s) const;

    friend bool operator==(const IesProfile&, const IesProfile&) = default;

  private:
    std::shared_ptr<const PhotometricWeb> web_;
    Vector3 axis_, zero_, quarter_;   // its axis, and azimuths 0 and 90 degrees perpendicular to it
    double cos_dark_;                 // dark outside this angle from the axis
    std::vector<double> cones_;       // cosines of the cones at which the profile has breaks
    bool breaks_at_equator_ = false;  // whether it also has one at the plane normal to the axis
    std::vector<Vector3> half_planes_;  // azimuthal directions at which the profile has breaks
};

/// A profile by a table over the angle from the axis (IsALampProfile).
class TableProfile {
  public:
    static constexpr std::string_view k_name = "table";

    TableProfile(const TableProfileDesc& desc, const LampPlacement& placement);

    double relative_intensity(const Vector3& v) const {
        return greatest_ * of_greatest_.relative_intensity(v);
    }
    double solid_angle() const { return greatest_ * of_greatest_.solid_angle(); }
    std::optional<double> peak_candelas() const { return std::nullopt; }
    bool has_even_core() const { return false; }
    DirectionCone cone() const { return of_greatest_.cone(); }
    void append_breaks(const Ray& ray, const Interval& interval, const Point3& apex,
                       std::vector<double>& s) const {
        of_greatest_.append_breaks(ray, interval, apex, s);
    }

    friend bool operator==(const TableProfile& a, const TableProfile& b) {
        return a.values_ == b.values_ && a.angles_ == b.angles_ &&
               a.of_greatest_.axis() == b.of_greatest_.axis();
    }

  private:
    std::vector<double> angles_, values_;
    double greatest_;
    IesProfile of_greatest_;  // relative to the greatest value
};

inline TableProfile make_profile(const TableProfileDesc& desc, const LampPlacement& placement,
                                 std::vector<std::string>& /*warnings*/) {
    return {desc, placement};
}

/// Reads the file. Adds a one-line warning if its candelas are inconsistent with its lumens. Throws
/// InputError for a file that is not LM-63, IoError for one that cannot be read.
IesProfile make_profile(const IesProfileDesc& desc, const LampPlacement& placement,
                        std::vector<std::string>& warnings);

/// All profiles, placed in the world: how a lamp's radiant intensity depends on direction. There is
/// one for each alternative of LampProfileDesc, with a function `make_profile` that constructs it
/// from its description, and soft ones for parts of lamps.
using LampProfile = std::variant<IsotropicProfile, SpotProfile, SoftSpotProfile, CosineProfile,
                                 TableProfile, IesProfile, LineProfile, ImageProfile>;

/// Makes the profile that `desc` describes. Reads the files it needs; adds warnings and throws as
/// that profile's make_profile does.
LampProfile make_lamp_profile(const LampProfileDesc& desc, const LampPlacement& placement,
                              std::vector<std::string>& warnings);

/// The profile of a point that represents a part of a lamp with an extent (`offset` and
/// `covariance`: SoftSpotProfile). Profiles without a steep edge vary too little across a part and
/// are returned as they are.
LampProfile softened(const LampProfile& profile, const Vector3& offset, const Matrix3& covariance);

/// The requirements on a profile.
///
/// - k_name: its name in reports ("spot").
/// - relative_intensity(v): intensity in the direction of `v` (from the lamp, of any length but for
///   SoftSpotProfile), relative to that where the lamp is brightest: 0..1.
/// - solid_angle(): the relative intensity integrated over the sphere [sr], the power of the lamp
///   for 1 W/sr where it is brightest.
/// - peak_candelas(): luminous intensity where it is brightest [cd], if the profile is absolute.
/// - has_even_core(): whether a relative intensity of 1 at a point implies 1 around it, up to a
///   break.
/// - cone(): a cone outside which it is dark.
/// - append_breaks(ray, interval, apex, s): appends distances along `ray` so that between those in
///   `interval` the profile of a lamp at `apex` is smooth and changes little, as compared with
///   where it is brightest in that interval: the edges of its beam and cones of equal intensity
///   inside. SoftSpotProfile may end between two of them.
///
/// Profiles of which a cone says too little have one or both of
///
/// - beam(ray, interval, apex): the part of an interval inside the cone outside which the profile
///   of a lamp at `apex` is dark.
/// - fine_structure(): what is narrower than the cone.
template <class P>
concept IsALampProfile = requires(const P& profile, const Vector3& v, const Ray& ray,
                                  const Interval& interval, const Point3& apex,
                                  std::vector<double>& s) {
    { P::k_name } -> std::convertible_to<std::string_view>;
    { profile.relative_intensity(v) } -> std::same_as<double>;
    { profile.solid_angle() } -> std::same_as<double>;
    { profile.peak_candelas() } -> std::same_as<std::optional<double>>;
    { profile.has_even_core() } -> std::same_as<bool>;
    { profile.cone() } -> std::same_as<DirectionCone>;
    profile.append_breaks(ray, interval, apex, s);
};

}  // namespace uw
