#pragma once

#include <pybind11/pybind11.h>

#include "core/scene/yaml/config_node.h"

namespace uw {

/// Python's objects as the value of a scene's key: dict, list, tuple and range, str and paths,
/// numbers, bool, None, and what has tolist(), as NumPy's arrays and numbers. Positions are left
/// empty. Throws TypeError for others.
ConfigNode node_of(pybind11::handle object);

/// The other way round: text that is no number is str, true and false are bool.
pybind11::object object_of(const ConfigNode& node);

/// A tree with all that it is made of, positions included, as tuples; and back.
pybind11::object state_of(const ConfigNode& node);
ConfigNode node_of_state(const pybind11::tuple& state);

}  // namespace uw
