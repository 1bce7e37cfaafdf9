#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/base/error.h"
#include "core/base/vector_math.h"
#include "core/scene/config_value.h"
#include "core/scene/scene_context.h"
#include "core/scene/trajectory.h"
#include "core/scene/volume_desc.h"

namespace uw {

/// A lamp's relative spectral distribution.
struct LampSpectrumDesc {
    enum class Type { flat, d65, blackbody, led, file };
    Type type = Type::flat;
    double temperature = 0;      ///< of a blackbody [K], 500..100000
    std::string name;            ///< of an LED among the CIE's illuminants, "LED-B3"
    std::filesystem::path file;  ///< CSV with a column wavelength_nm and
    std::string column;          ///< this one; empty: the only other one
    SourceLocation where;
};

/// The luminous surface of a lamp that is not a point, with its centre at the lamp's position: flat
/// and perpendicular to the lamp's direction, or a sphere. Every point of it has the lamp's
/// profile.
struct LampExtentDesc {
    enum class Shape { rectangle, disk, sphere };

    Shape shape = Shape::rectangle;
    double width = 0, height = 0;  ///< of a rectangle [m]
    /// Rotation of a rectangle about the lamp's direction [degrees], -360..360. At 0 its width lies
    /// along LampPlacement::across.
    double rotate = 0;
    double radius = 0;  ///< of a disk or a sphere [m]
    int samples = 32;   ///< number of points that represent it, 1..1024

    friend bool operator==(const LampExtentDesc&, const LampExtentDesc&) = default;
};

/// An isotropic profile.
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

/// A table over the angle from the axis, all around it.
struct TableProfileDesc {
    static constexpr bool k_is_absolute = false;

    std::vector<double> angles;  ///< [degrees], ascending from 0 to at most 180; two or more
    std::vector<double> values;  ///< at these, 0..1, not all 0; linear in between, 0 beyond
};

/// The photometry of a luminaire, from an IES file (LM-63).
struct IesProfileDesc {
    static constexpr bool k_is_absolute = true;  // in candelas

    std::filesystem::path file;
    double rotate = 0;  ///< rotation about the lamp's direction [degrees], -360..360
    double tilt = 0;    ///< then tilt towards the luminaire's azimuth 0 [degrees], -180..180
    SourceLocation where = "profile";
};

/// A line laser: a fan of light in the plane of the lamp's direction and LampPlacement::across.
struct LineProfileDesc {
    static constexpr bool k_is_absolute = false;

    double angle = 0;   ///< full angle of the fan [degrees], 0 < angle <= 170
    double width = 0;   ///< full angle across it at half intensity [degrees], 0 < width <= 20
    double rotate = 0;  ///< rotation of its plane about the lamp's direction [degrees], -360..360
};

/// A pattern from an image: that of a projector, or of a mask in front of a lamp.
struct ImageProfileDesc {
    static constexpr bool k_is_absolute = false;

    std::filesystem::path file;
    double fov = 0;     ///< full angle of the image's width [degrees], 0 < fov < 180
    double rotate = 0;  ///< rotation about the lamp's direction [degrees], -360..360
    SourceLocation where = "profile";
};

/// How a lamp's radiant intensity depends on direction. core/light/lamp_profile.h constructs the
/// profiles, core/scene/lamp_desc.h reads the descriptions; neither compiles unless it
/// handles all of them.
using LampProfileDesc =
    std::variant<IsotropicProfileDesc, SpotProfileDesc, CosineProfileDesc, TableProfileDesc,
                 IesProfileDesc, LineProfileDesc, ImageProfileDesc>;

/// The properties of a lamp that is a sun: its light is parallel, or comes from a disc in the sky,
/// and enters the water through its surface.
struct SunDesc {
    double angle = 0;  ///< angular diameter of the disc, in the water [degrees], 0..90
    int samples = 32;  ///< number of directions that represent it unless the angle is 0, 1..1024
    WaterSurfaceDesc surface;  ///< the scene's (WaterDesc::surface)

    friend bool operator==(const SunDesc&, const SunDesc&) = default;
};

struct SkyDesc;  // core/scene/sky_desc.h

/// The properties of a lamp that is an emissive volume: the volume's grid determines where it
/// emits.
struct EmissiveVolumeDesc {
    std::size_t volume = 0;  ///< index in SceneDesc::volumes
    EmissionDesc emission;

    friend bool operator==(const EmissiveVolumeDesc&, const EmissiveVolumeDesc&) = default;
};

/// A lamp: a point, one with an extent, a sun, the sky, or an emissive volume.
struct LampDesc {
    std::string name;                      ///< of its layers; unique in the scene
    Point3 position;                       ///< in its frame [m]
    Vector3 direction{0, 0, 1};            ///< in its frame, unit
    std::optional<LampExtentDesc> extent;  ///< none: it is a point
    /// Set for a sun, which has no position, no extent and no profile; its frame is the world.
    std::optional<SunDesc> sun;
    /// Set for the light of the sky, which comes from all directions; `sun` is then set, too.
    std::shared_ptr<const SkyDesc> sky;
    /// Set for an emissive volume, which emits in all directions from where the volume's grid has
    /// values, in the world: `position` is unused, and `intensity` is EmissionDesc::per_unit.
    std::optional<EmissiveVolumeDesc> emissive_volume;
    LampProfileDesc profile;
    // At most one of the next three is set; none for a profile that is absolute.
    std::optional<PerBand> intensity;  ///< on the axis [W/sr]; with a spectrum, a single total
    std::optional<PerBand> power;      ///< [W]; with a spectrum, a single total
    std::optional<double> lumens;      ///< luminous flux [lm]; only with a spectrum
    // A sun has either `intensity`, but as irradiance perpendicular to it at the water's surface
    // [W/m^2], or `lumens`, as illuminance there [lx].
    std::optional<LampSpectrumDesc> spectrum;
    bool fixed_to_camera = true;  ///< its frame is the camera's, else world_from_mount
    Affine world_from_mount;      ///< rigid
    bool fixed_to_rig = false;    ///< world_from_mount moves with the rig
    /// How its frame moves; then world_from_mount is that of the scene's moment.
    std::optional<TrajectoryDesc> trajectory;
    SourceLocation where;

    /// Whether all that it is, is in another part of the scene: of a volume or the sky.
    bool is_of_scene() const { return emissive_volume || sky; }

    /// Maps the lamp's frame to the world.
    const Affine& world_from_frame(const Affine& world_from_camera) const {
        return fixed_to_camera ? world_from_camera : world_from_mount;
    }
};

/// `spectrum` of a lamp, or `white` of `render`, the light displayed as white.
LampSpectrumDesc read_spectrum(const ConfigValue& value, const SceneContext& context);

/// `lamps`.
std::vector<LampDesc> read_lamps(const ConfigValue& value, const SceneContext& context);

/// Appends the emissive volumes to a scene's lamps. Throws InputError for a name that is taken.
void append_emissions(const std::vector<VolumeDesc>& volumes, std::vector<LampDesc>& lamps);

}  // namespace uw
