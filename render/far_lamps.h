#pragma once

#include <optional>
#include <string>

#include "render/scene_assembly.h"

namespace uw {

/// The optical depth, in the clearest band, that the light of the nearest lamp passes to where
/// light paths from the camera begin: the camera, or a surface in view that the lamp lights. With
/// columns of the volumes. None without lamps.
std::optional<double> depth_of_nearest_lamp(const AssembledScene& scene);

/// One line about lamps too far away for the fast form of multiple scattering: its paths begin at
/// the camera and seldom come near such lamps, so that few of them carry nearly all the light. None
/// where it is not what the scene is rendered by.
std::optional<std::string> far_lamp_warning(const AssembledScene& scene);

}  // namespace uw
