#pragma once

#include "cli/points/points_options.h"
#include "render/resolved_scene.h"
#include "render/scene_assembly.h"

namespace uw {

/// The scene that the arguments name as one camera sees it, without what neither refracts nor
/// occludes: volumes and lamps. Throws UsageError, InputError and IoError.
ResolvedScene observed_scene(const PointsArguments& arguments);

/// It with its surfaces; prints the warnings about them. Throws InputError and IoError.
AssembledScene with_surfaces(const ResolvedScene& scene);

}  // namespace uw
