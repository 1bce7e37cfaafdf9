#pragma once

#include <string>

#include "cli/info/advice.h"
#include "media/vdb/vdb_inspect.h"

namespace uw {

/// ASCII letters in lower case, for names in which case means nothing.
std::string lower_case(std::string text);

/// How likely a grid of this name holds a concentration: 0 certainly not, 1 something else from
/// which a concentration can be guessed (heat, flames), 2 unknown, 3 likely, 4 a density.
int concentration_likelihood(const std::string& name);

/// Whether a grid's values can be concentrations, whatever its name.
bool can_be_mapped(const GridInspection& grid);

/// The likeliest concentration of those that can be mapped; nullptr if there is none.
const GridInspection* likeliest_grid(const VdbInspection& inspection);

/// Decides `advice.map`, sets `advice.bounds` to what these grids hold, and says why and what else
/// there is.
void choose_grids(const VdbInspection& inspection, VdbAdvice& advice);

/// Says what is wrong with each grid's values.
void say_what_is_wrong(const VdbInspection& inspection, VdbAdvice& advice);

}  // namespace uw
