#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/light/phase_function.h"
#include "core/scene/water_desc.h"

namespace uw {

/// Builds the phase function that a scene describes. Reads table files; one that does not look like
/// a phase function (its integral is far from 1, or much of it lies beyond its angles) adds a line
/// to `warnings`. Invalid parameters or contents: InputError; an unreadable file: IoError; both
/// starting with `desc.where`.
std::shared_ptr<const PhaseFunction> make_phase_function(const PhaseDesc& desc,
                                                         std::vector<std::string>& warnings);

}  // namespace uw
