#pragma once

#include <filesystem>
#include <optional>

#include "core/scene/variations/variations_desc.h"
#include "core/scene/yaml/config_node.h"

namespace uw {

/// The section `variations` of a scene's tree; none if it has none. `file` is the scene's, to whose
/// folder the names of tables are relative. Whether the scene has the keys that are drawn shows
/// when they are set. Throws InputError "file:line:column: key path: what; mend", and as
/// read_csv_file.
std::optional<VariationsDesc> read_variations(const ConfigNode& scene,
                                              const std::filesystem::path& file);

}  // namespace uw
