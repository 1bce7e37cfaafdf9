#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/affine.h"
#include "core/scene/scene_arrays.h"
#include "core/scene/trajectory_desc.h"
#include "core/scene/water_surface_desc.h"
#include "core/scene/yaml/config_value.h"

namespace uw {

/// Shared by the readers of a scene's sections. Each reads and fully checks one section, and throws
/// InputError "file:line:column: key path: what; mend" for invalid input.
struct SceneContext {
    std::filesystem::path folder;        // of the scene file; file names are relative to it
    std::size_t band_count = 0;          // of water.bands, which is read first
    std::vector<std::string>* warnings;  // one line each
    std::optional<WaterSurfaceDesc> water_surface{};  // of water, which is read before the lamps
    /// For a scene with a rig, which is read before its lamps.
    struct RigFrames {
        Affine world_from_rig, world_from_camera;  // the first camera's
    };
    std::optional<RigFrames> rig{};
    std::optional<TrajectoryDesc> rig_trajectory{};  // likewise
    const SceneArrays* arrays = nullptr;             // null: the scene has files alone

    /// Adds the warning "<location>: <what>".
    void warn(const ConfigValue& value, const std::string& what) const {
        warnings->push_back(value.location() + ": " + what);
    }
};

}  // namespace uw
