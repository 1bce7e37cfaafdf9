#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/affine.h"
#include "core/base/vec.h"
#include "core/scene/lamp_extent_desc.h"
#include "core/scene/lamp_profile_desc.h"
#include "core/scene/lamp_spectrum_desc.h"
#include "core/scene/per_band.h"
#include "core/scene/source_location.h"
#include "core/scene/sun_desc.h"
#include "core/scene/trajectory_desc.h"

namespace uw {

/// A lamp: a point, one with an extent, or a sun.
struct LampDesc {
    std::string name;                      ///< of its layers; unique in the scene
    Point3 position;                       ///< in its frame [m]
    Vector3 direction{0, 0, 1};            ///< in its frame, unit
    std::optional<LampExtentDesc> extent;  ///< none: it is a point
    /// Set for a sun, which has no position, no extent and no profile; its frame is the world.
    std::optional<SunDesc> sun;
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

    /// Maps the lamp's frame to the world.
    const Affine& world_from_frame(const Affine& world_from_camera) const {
        return fixed_to_camera ? world_from_camera : world_from_mount;
    }
};

}  // namespace uw
