#pragma once

#include <concepts>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/base/ray.h"
#include "core/lamps/cosine_profile.h"
#include "core/lamps/direction_cone.h"
#include "core/lamps/ies_profile.h"
#include "core/lamps/isotropic_profile.h"
#include "core/lamps/lamp_placement.h"
#include "core/lamps/spot_profile.h"
#include "core/scene/lamp_profile_desc.h"

namespace uw {

/// All profiles, placed in the world: how a lamp's radiant intensity depends on direction. There is
/// one for each alternative of LampProfileDesc, and beside it a function `make_profile` that
/// constructs it from its description.
using LampProfile = std::variant<IsotropicProfile, SpotProfile, CosineProfile, IesProfile>;

/// Makes the profile that `desc` describes. Reads the files it needs; adds warnings and throws as
/// that profile's make_profile does.
LampProfile make_lamp_profile(const LampProfileDesc& desc, const LampPlacement& placement,
                              std::vector<std::string>& warnings);

/// The requirements on a profile.
///
/// - k_name: its name in reports ("spot").
/// - relative_intensity(v): intensity in the direction of `v` (from the lamp, of any length),
///   relative to that where the lamp is brightest: 0..1.
/// - solid_angle(): the relative intensity integrated over the sphere [sr], the power of the lamp
///   for 1 W/sr where it is brightest.
/// - peak_candelas(): luminous intensity where it is brightest [cd], if the profile is absolute.
/// - has_even_core(): whether a relative intensity of 1 at a point implies 1 around it, up to a
///   break.
/// - cone(): a cone outside which it is dark.
/// - append_breaks(ray, stretch, apex, s): appends distances along `ray` so that between those in
///   `stretch` the profile of a lamp at `apex` is smooth and changes little, as compared with where
///   it is brightest in that interval: the edges of its beam and cones of equal intensity inside.
template <class P>
concept IsALampProfile = requires(const P& profile, const Vector3& v, const Ray& ray,
                                  const Interval& stretch, const Point3& apex,
                                  std::vector<double>& s) {
    { P::k_name } -> std::convertible_to<std::string_view>;
    { profile.relative_intensity(v) } -> std::same_as<double>;
    { profile.solid_angle() } -> std::same_as<double>;
    { profile.peak_candelas() } -> std::same_as<std::optional<double>>;
    { profile.has_even_core() } -> std::same_as<bool>;
    { profile.cone() } -> std::same_as<DirectionCone>;
    profile.append_breaks(ray, stretch, apex, s);
};

}  // namespace uw
