#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/affine.h"
#include "core/base/vec.h"
#include "core/scene/lamp_profile_desc.h"
#include "core/scene/lamp_spectrum_desc.h"
#include "core/scene/per_band.h"
#include "core/scene/source_location.h"

namespace uw {

/// A lamp, small enough to count as a point.
struct LampDesc {
    std::string name;            ///< of its layers; no other lamp of the scene has it
    Point3 position;             ///< in its frame [m]
    Vector3 direction{0, 0, 1};  ///< in its frame, unit
    LampProfileDesc profile;
    // At most one of the next three is set; none is for a profile that is absolute.
    std::optional<PerBand> intensity;  ///< on the axis [W/sr]; with a spectrum one value for all
    std::optional<PerBand> power;      ///< [W]; with a spectrum one value for all of it
    std::optional<double> lumens;      ///< luminous flux [lm]; with a spectrum only
    std::optional<LampSpectrumDesc> spectrum;
    bool fixed_to_camera = true;  ///< its frame is the camera's, else world_from_mount
    Affine world_from_mount;      ///< rigid
    SourceLocation where;
};

}  // namespace uw
