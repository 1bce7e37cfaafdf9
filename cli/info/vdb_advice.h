#pragma once

#include <filesystem>
#include <string>

#include "cli/info/advice.h"
#include "media/vdb/vdb_inspect.h"

namespace uw {

/// Advice on `inspection`; reads the grids to map once more, for their optical depth. `file`: the
/// file's name to write into the scene.
VdbAdvice advise_on_vdb(const VdbInspection& inspection, const std::filesystem::path& file);

/// How likely a grid of this name holds a concentration: 0 certainly not, 1 something else from
/// which a concentration can be guessed (heat, flames), 2 unknown, 3 likely, 4 a density.
int concentration_likelihood(const std::string& name);

}  // namespace uw
