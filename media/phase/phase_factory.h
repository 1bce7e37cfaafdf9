#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/optics/phase_function.h"
#include "core/scene/phase_desc.h"

namespace uw {

/// Builds the phase function a scene describes. A table's file is read here; one that does not
/// look like a phase function (its integral far from 1, much of it beyond its angles) adds a line
/// to `warnings`. Impossible parameters or contents: InputError; an unreadable file: IoError; both
/// starting with `desc.where`.
std::shared_ptr<const PhaseFunction> make_phase_function(const PhaseDesc& desc,
                                                         std::vector<std::string>& warnings);

}  // namespace uw
