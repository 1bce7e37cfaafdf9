#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/vector_math.h"
#include "core/geometry/mesh.h"
#include "core/scene/scene_desc.h"

namespace uw {

/// A camera of a glTF file. It looks along -z with y up in its own space.
struct GltfCamera {
    std::string name;  // of its node, or its own if the node has none
    bool perspective = true;
    double yfov = 0;          // full angle of view, top to bottom [rad], 0 to pi
    double aspect_ratio = 0;  // width over height; 0: not given
    /// Blender's lens shift, in units of the image's side that its sensor fit names; from custom
    /// properties of the camera or its object (glTF `extras`), since the format has none.
    enum class SensorFit { automatic, horizontal, vertical };
    double shift_x = 0, shift_y = 0;
    SensorFit sensor_fit = SensorFit::automatic;  // the longer side
    Affine file_from_camera;
};

/// A light of a glTF file (KHR_lights_punctual). It shines along -z in its own space.
struct GltfLight {
    enum class Type { point, spot, directional };
    std::string name;  // as a camera's
    Type type = Type::point;
    Rgb color{1, 1, 1};                     // linear
    double intensity = 1;                   // candela by the extension; see LightUnits
    double inner_cone = 0, outer_cone = 0;  // spot: angles to the axis [rad], inner < outer <= pi/2
    bool has_range = false;                 // a distance beyond which it emits nothing
    Affine file_from_light;
};

/// Major and minor version of Blender: 3.4 is {3, 4}.
using BlenderVersion = std::pair<int, int>;

/// The cameras and lights of a glTF file, in the order of its scene's nodes.
struct GltfItems {
    std::vector<GltfCamera> cameras;
    std::vector<GltfLight> lights;
    std::optional<BlenderVersion> written_by_blender;  // the version, of a file that Blender wrote
};

/// Reads the cameras and lights of a glTF file, where its animations have them at `time` [s], or
/// where its nodes are written; no mesh or image is loaded. Throws IoError, InputError.
GltfItems read_gltf_items(const std::filesystem::path& file,
                          const std::optional<double>& time = {});

/// Imports the cameras and lights that `geometry` requests from its glTF files (GltfImportDesc)
/// into `scene.camera` and `scene.lamps`, placed by the files' nodes and the entries' transforms,
/// with warnings about anything that cannot be used, and in a scene without lamps about
/// lights that could be. A scene that requests nothing is otherwise left unchanged. Importing twice
/// would duplicate every lamp: scenes to be rendered are imported by ImageScene alone.
/// Precondition: a frame has been chosen for all sequences.
///
/// - The camera supplies what the scene's own omits: the focal length from its vertical angle of
///   view and the scene's resolution, with square pixels and the principal point at the centre but
///   for its lens shift, and the pose. Scale and mirroring along its axes are ignored.
/// - Lamps are fixed to the world. Point lights are isotropic, spots fall off as glTF
///   says, or in files that Blender wrote as that version of it shades them; directional lights are
///   not supported: lamps have a position. Intensities are W/sr, times the colour as
///   ReflectanceBands converts it to bands; scale does not affect them. Names are those of the
///   files, with '_' for characters not allowed in a layer's name, and "_2" etc. for duplicates.
///
/// Throws IoError, InputError: a camera or light that does not exist, an orthographic camera.
void import_gltf(SceneDesc& scene);

}  // namespace uw
