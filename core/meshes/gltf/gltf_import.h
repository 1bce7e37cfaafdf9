#pragma once

#include "core/scene/scene_desc.h"

namespace uw {

/// Puts the cameras and lights that `geometry` asks its glTF files for (GltfImportDesc) into
/// `scene.camera` and `scene.lamps`, placed by the files' nodes and the entries' transforms, with
/// warnings about what cannot be used. A scene that asks for nothing is left as it is. Doing it
/// twice would bring every lamp twice: scenes that are rendered are imported by ResolvedScene
/// alone. Precondition: a frame has been chosen of what are sequences.
///
/// - The camera gives what the scene's own leaves out: the focal length from its vertical angle of
///   view and the scene's resolution, with square pixels and the principal point in the middle; and
///   the pose. Scale and mirroring along its axes are left out.
/// - Lamps stand in the world. Point lights are isotropic, spots have glTF's falloff, directional
///   lights cannot be: lamps are points. Intensities are W/sr, times the colour as
///   ReflectanceBands turns it into bands; scale leaves them as they are. Names are those of the
///   files with '_' for what a layer's name cannot have, and "_2" and so on where one is taken.
///
/// Throws IoError, InputError: a camera or light that is not there, an orthographic camera.
void import_gltf(SceneDesc& scene);

}  // namespace uw
