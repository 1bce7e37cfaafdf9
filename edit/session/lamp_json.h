#pragma once

#include <cstddef>

#include "core/json/json.h"
#include "core/scene/yaml/config_node.h"
#include "edit/session/edited_scene.h"

namespace uw {

/// One lamp of the state (docs/edit-api.md): what the file says of it, where it is in the world and
/// in the image. `tree` is the scene file's.
Json lamp_json(const EditedScene& edited, std::size_t index, const ConfigNode& tree);

/// The lamp spectra that a scene can name without a file, as values of `spectrum`.
Json lamp_spectrum_names_json();

}  // namespace uw
