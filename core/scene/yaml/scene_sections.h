#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/scene_desc.h"
#include "core/scene/yaml/config_value.h"

namespace uw {

/// What the readers of a scene's sections share. Private to the scene reader: one function per
/// section, each of which checks all of its section and throws InputError (see read_scene).
struct SceneContext {
    std::filesystem::path folder;        // of the scene file; file names are relative to it
    std::size_t band_count = 0;          // of water.bands, which is read first
    std::vector<std::string>* warnings;  // one line each
    /// Of a scene with a rig, which is read before its lamps.
    struct RigFrames {
        Affine world_from_rig, world_from_camera;  // the first camera's
    };
    std::optional<RigFrames> rig;

    /// Adds the warning "<location>: <what>".
    void warn(const ConfigValue& value, const std::string& what) const {
        warnings->push_back(value.location() + ": " + what);
    }
};

CameraDesc read_camera(const ConfigValue& value, const SceneContext& context);
/// `cameras` and `rig`, also the frames that lamps of a rig are fixed to.
std::vector<RigCameraDesc> read_cameras(const ConfigValue& value,
                                        const std::optional<ConfigValue>& rig,
                                        SceneContext& context);
/// A name that becomes part of `of` ("a layer's name"): letters, digits, _ and - only.
std::string read_short_name(const ConfigValue& value, std::string_view of, std::string_view mend);
/// `camera.port`.
PortDesc read_port(const ConfigValue& value, const SceneContext& context);
/// `camera.pose` as world_from_camera.
Affine read_pose(const ConfigValue& value);

/// Also sets the number of bands for the sections that follow.
WaterDesc read_water(const ConfigValue& value, SceneContext& context);
PhaseDesc read_phase(const ConfigValue& value, const SceneContext& context);

std::vector<VolumeDesc> read_volumes(const ConfigValue& value, const SceneContext& context);
std::vector<GeometryDesc> read_geometry(const ConfigValue& value, const SceneContext& context);
std::vector<LampDesc> read_lamps(const ConfigValue& value, const SceneContext& context);
LampSpectrumDesc read_spectrum(const ConfigValue& value, const SceneContext& context);
/// `response` and `white` of `render`.
ColourDesc read_colour(class ConfigMap& render, const SceneContext& context);
RenderDesc read_render(const ConfigValue& value, const SceneContext& context);

/// `transform: {scale, rotate, translate}` as translate * rotate * scale.
Affine read_transform(const ConfigValue& value);

/// A file name, resolved against the scene's folder. Throws InputError where no such file exists.
std::filesystem::path read_existing_file(const ConfigValue& value, const SceneContext& context);
/// Likewise, but a name with places for a frame's number that no file has as it is written stands
/// for a sequence; its files are not looked at.
std::filesystem::path read_existing_file_or_sequence(const ConfigValue& value,
                                                     const SceneContext& context,
                                                     bool& is_sequence);

}  // namespace uw
