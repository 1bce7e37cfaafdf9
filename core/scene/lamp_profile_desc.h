#pragma once

#include <filesystem>
#include <variant>

#include "core/scene/source_location.h"

namespace uw {

/// As bright in all directions.
struct IsotropicProfileDesc {
    /// Whether the profile tells how bright the lamp is, too, so that it need not be given.
    static constexpr bool k_is_absolute = false;
};

/// Even within a cone, falling to nothing over an edge.
struct SpotProfileDesc {
    static constexpr bool k_is_absolute = false;
    /// How the intensity falls over the edge: as a smoothstep of the angle, or as glTF's spots do,
    /// by the square of what is left of the cosine's way (KHR_lights_punctual).
    enum class Falloff { smooth, gltf };

    double beam = 0;  ///< full angle at half intensity [degrees], 0 < beam <= 180
    double edge = 0;  ///< angle over which it falls from full to none [degrees], 0..beam
    Falloff falloff = Falloff::smooth;
};

/// A power of the cosine of the angle from the axis, dark behind the lamp.
struct CosineProfileDesc {
    static constexpr bool k_is_absolute = false;

    double fwhm = 0;  ///< full angle at half intensity [degrees], 0 < fwhm < 180
};

/// The photometry of a luminaire, from an IES file (LM-63).
struct IesProfileDesc {
    static constexpr bool k_is_absolute = true;  // it has candelas

    std::filesystem::path file;
    double rotate = 0;  ///< turn about the lamp's direction [degrees], -360..360
    double tilt = 0;    ///< then from it towards the luminaire's azimuth 0 [degrees], -180..180
    SourceLocation where = "profile";
};

/// How a lamp's radiant intensity depends on direction. core/lamps/lamp_profile.h makes what each
/// describes, core/scene/yaml/lamp_reader.h reads it; neither compiles before it knows all of them.
using LampProfileDesc =
    std::variant<IsotropicProfileDesc, SpotProfileDesc, CosineProfileDesc, IesProfileDesc>;

}  // namespace uw
