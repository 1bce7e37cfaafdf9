#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/scene/camera_desc.h"
#include "core/scene/geometry_desc.h"
#include "core/scene/lamp_desc.h"
#include "core/scene/render_desc.h"
#include "core/scene/trajectory_desc.h"
#include "core/scene/volume_desc.h"
#include "core/scene/water_desc.h"

/// The scene file as inert data (docs/scene-file.md), one header per section. Lengths in metres,
/// angles in degrees, wavelengths in nm, coefficients in 1/m, concentrations in ppm by volume. File
/// names are already resolved against the scene file's folder. Per-band lists hold exactly one
/// value per band. `where` is the location in the file, for messages.
namespace uw {

/// Which of the images that a scene describes to render.
struct ImageChoice {
    std::optional<int> frame;  // none: files are named as they are, the time is the first
    std::size_t camera = 0;    // of its rig, by index

    friend bool operator==(const ImageChoice&, const ImageChoice&) = default;
};

/// All of a scene file.
struct SceneDesc {
    std::filesystem::path file;          ///< the scene file itself
    CameraDesc camera;                   ///< of a rig, the one rendered: initially its first
    std::string camera_name;             ///< empty: the scene has one camera, no rig
    std::vector<RigCameraDesc> cameras;  ///< of a rig; else none
    /// How the rig moves: until the scene's moment is set, its cameras and lamps have poses in the
    /// rig's axes.
    std::optional<TrajectoryDesc> rig_trajectory;
    /// The moment that all poses are of [s]; none: not set (render/scene_motion.h).
    std::optional<double> time;
    /// The scene as it was read, of which this is the image `choice`, for what other frames show;
    /// null: it is that itself (scene_of_image).
    std::shared_ptr<const SceneDesc> whole;
    ImageChoice choice;
    WaterDesc water;
    std::vector<VolumeDesc> volumes;
    std::vector<GeometryDesc> geometry;
    std::vector<LampDesc> lamps;
    RenderDesc render;
    std::string hash;                   ///< of the text as read with overrides, for image headers
    std::vector<std::string> warnings;  ///< one line each
};

}  // namespace uw
