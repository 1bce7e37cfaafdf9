#pragma once

#include "cli/info/advice.h"
#include "media/vdb/vdb_inspect.h"

namespace uw {

/// Says which way is up and where values lie, by the program that wrote the file, and decides
/// `advice.voxel_size`. Precondition of all three: `advice.map` is decided.
void say_placement(const VdbInspection& inspection, VdbAdvice& advice);

/// Says whether the size is plausible, by `advice.bounds`, and decides `advice.scale` and
/// `advice.translate`.
void say_units(const VdbInspection& inspection, VdbAdvice& advice);

/// Says how to blur it by its motion, if the file has velocities.
void say_motion(const VdbInspection& inspection, VdbAdvice& advice);

}  // namespace uw
