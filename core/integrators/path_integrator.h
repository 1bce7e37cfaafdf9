#pragma once

#include "core/integrators/integrator_kind.h"

namespace uw {

/// All light by random paths from the camera, without bias (`render.integrator: path`). What traces
/// them, LightTransport::paths, is left to the caller of `make`: paths are made of integrators, not
/// the other way round.
extern const IntegratorKind k_path_kind;

}  // namespace uw
