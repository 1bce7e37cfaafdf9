#pragma once

#include "cli/info/advice.h"
#include "media/vdb/vdb_inspect.h"

namespace uw {

/// Chooses `small_ppm` and `large_ppm` of the grids in `advice.map`, at `advice.scale`, such that
/// the optical depth is 1.5 at 540 nm, with small and large particles each contributing about half
/// of it. Fills in `optical_depth` and `bounds`. Throws InputError if the grids cannot be loaded.
void start_concentrations(const VdbInspection& inspection, VdbAdvice& advice);

/// Begins with these and goes on, by drafts, to what makes the plume plain to see; decides
/// `advice.view`, extends `bounds` by those of `others`, which are in the file's size and place,
/// and adds a line about it.
void choose_concentrations(const VdbInspection& inspection, const Bounds& others,
                           VdbAdvice& advice);

}  // namespace uw
