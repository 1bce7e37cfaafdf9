#pragma once

#include <filesystem>
#include <variant>

#include "core/scene/source_location.h"

namespace uw {

/// Equally bright in all directions.
struct IsotropicProfileDesc {
    /// Whether the profile also determines the lamp's brightness, so that it need not be given.
    static constexpr bool k_is_absolute = false;
};

/// Constant within a cone, falling to zero across its edge.
struct SpotProfileDesc {
    static constexpr bool k_is_absolute = false;
    /// The falloff across the edge, from beam/2 - edge/2 to beam/2 + edge/2 of the axis:
    ///
    /// - smooth: a smoothstep of the angle.
    /// - gltf: the square of the linear ramp in the cosine (KHR_lights_punctual).
    /// - blender: as Cycles shades Blender's spots since 3.5, a smoothstep of the cosine. With
    ///   Blender's Size and Blend, beam/2 + edge/2 = Size/2 = h and edge = h Blend; the ramp begins
    ///   at the cosine cos h + (1 - cos h) Blend. h <= 90 degrees.
    /// - blender_3_4: as it did up to 3.4, times the cosine of the angle to the axis.
    enum class Falloff { smooth, gltf, blender, blender_3_4 };

    double beam = 0;  ///< full angle at half intensity if smooth [degrees], 0 < beam <= 180
    double edge = 0;  ///< angle over which it falls from full to zero [degrees], 0..beam
    Falloff falloff = Falloff::smooth;
};

/// A power of the cosine of the angle from the axis, dark behind the lamp.
struct CosineProfileDesc {
    static constexpr bool k_is_absolute = false;

    double fwhm = 0;  ///< full angle at half intensity [degrees], 0 < fwhm < 180
};

/// The photometry of a luminaire, from an IES file (LM-63).
struct IesProfileDesc {
    static constexpr bool k_is_absolute = true;  // in candelas

    std::filesystem::path file;
    double rotate = 0;  ///< rotation about the lamp's direction [degrees], -360..360
    double tilt = 0;    ///< then tilt towards the luminaire's azimuth 0 [degrees], -180..180
    SourceLocation where = "profile";
};

/// How a lamp's radiant intensity depends on direction. core/lamps/lamp_profile.h constructs the
/// profiles, core/scene/yaml/lamp_reader.h reads the descriptions; neither compiles unless it
/// handles all of them.
using LampProfileDesc =
    std::variant<IsotropicProfileDesc, SpotProfileDesc, CosineProfileDesc, IesProfileDesc>;

}  // namespace uw
