#pragma once

#include "cli/info/advice.h"
#include "media/vdb/vdb_inspect.h"

namespace uw {

/// Chooses `small_ppm` and `large_ppm` of the grids in `advice.map`, at `advice.scale`, so that the
/// plume is neither invisible nor black: an optical depth of 1.5 at 540 nm, with small and large
/// particles each contributing about half of it. Fills in `optical_depth` and `bounds` and adds a
/// line about it. Throws InputError if the grids cannot be loaded.
void choose_concentrations(const VdbInspection& inspection, VdbAdvice& advice);

}  // namespace uw
