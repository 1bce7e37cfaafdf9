#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/camera_desc.h"
#include "core/scene/geometry_desc.h"
#include "core/scene/lamp_desc.h"
#include "core/scene/meter_desc.h"
#include "core/scene/navigation_sensor_desc.h"
#include "core/scene/render_desc.h"
#include "core/scene/scene_context.h"
#include "core/scene/trajectory.h"
#include "core/scene/volume_desc.h"
#include "core/scene/water_desc.h"
#include "core/scene/yaml_document.h"

namespace uw {

/// The scene file as inert data (docs/scene-file.md), one header per section. Lengths in metres,
/// angles in degrees, wavelengths in nm, coefficients in 1/m, concentrations in ppm by volume. File
/// names are already resolved against the scene file's folder. Per-band lists hold exactly one
/// value per band. `where` is the location in the file, for messages.

/// Which of the images that a scene describes to render.
struct ImageChoice {
    std::optional<int> frame;  // none: files are named as they are, the time is the first
    std::size_t camera = 0;    // of its rig, by index

    friend bool operator==(const ImageChoice&, const ImageChoice&) = default;
};

/// A scene, section by section. As read from a file it describes all images: every frame, camera
/// and moment. The scene of one image is made from it (render/image_scene.h).
struct SceneDesc {
    std::filesystem::path file;          ///< the scene file itself
    CameraDesc camera;                   ///< of a rig, its first, or the one that sees the image
    std::string camera_name;             ///< likewise; empty: the scene has one camera, no rig
    std::vector<RigCameraDesc> cameras;  ///< of a rig; else none
    /// How the rig moves: as they are read, its cameras and lamps have poses in the rig's axes.
    std::optional<TrajectoryDesc> rig_trajectory;
    WaterDesc water;
    std::vector<VolumeDesc> volumes;
    std::vector<GeometryDesc> geometry;
    std::vector<LampDesc> lamps;
    std::vector<MeterDesc> meters;                 ///< of `sensors`
    std::vector<NavigationSensorDesc> navigation;  ///< the others of `sensors`
    RenderDesc render;
    std::vector<NamedFile> files;       ///< that its keys name, with the patterns of sequences
    std::string hash;                   ///< of the text as read with overrides, for image headers
    std::vector<std::string> warnings;  ///< one line each
};

/// Reads a scene file (version 1, docs/scene-file.md) and checks all of it. `overrides` are
/// "key.path=value" as given to --set, applied in order before checking. Throws InputError with one
/// line "file:line:column: key path: what; hint", IoError if the file cannot be read, UsageError
/// for an override that is not of that form.
SceneDesc read_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides);

/// The same for a scene whose text is in memory, such as one that is being edited: `file`, by which
/// messages and file names are resolved, is not read.
SceneDesc read_scene_text(std::string_view text, const std::filesystem::path& file,
                          const std::vector<std::string>& overrides = {});

/// The section of a scene that describes its variations. It is not part of the scene itself: it is
/// ignored here, and read by core/scene/variations.
inline constexpr std::string_view k_variations_key = "variations";

/// In two steps: the tree of a scene with its overrides, and the scene that it describes, which may
/// refer to what is in `arrays`. Both throw as read_scene.
ConfigNode read_scene_tree(const std::filesystem::path& file,
                           const std::vector<std::string>& overrides);
ConfigNode scene_tree(std::string_view text, const std::filesystem::path& file,
                      const std::vector<std::string>& overrides = {});
SceneDesc scene_of_tree(const ConfigNode& root, const std::filesystem::path& file,
                        const SceneArrays* arrays = nullptr);

/// The `water` of a scene without a file: the defaults, with `overrides` such as
/// "water.preset=jerlov-II" applied as read_scene does. Keys of other sections are errors; file
/// names are relative to the current folder. Throws as read_scene.
WaterDesc read_water_overrides(const std::vector<std::string>& overrides);

/// Reads the water of a tree whose only section is `water`.
WaterDesc water_of_tree(const ConfigNode& root);

}  // namespace uw
