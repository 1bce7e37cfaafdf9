#pragma once

#include "core/scene/scene_desc.h"

namespace uw {

/// Imports the cameras and lights that `geometry` requests from its glTF files (GltfImportDesc)
/// into `scene.camera` and `scene.lamps`, placed by the files' nodes and the entries' transforms,
/// with warnings about anything that cannot be used, and in a scene without lamps about
/// lights that could be. A scene that requests nothing is otherwise left unchanged. Importing twice
/// would duplicate every lamp: scenes to be rendered are imported by ResolvedScene alone.
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
