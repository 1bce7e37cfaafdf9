#pragma once

#include "core/light/integrator_kind.h"

namespace uw {

/// The requirements, checks and factory of an integrator; k_integrator_names holds the names that
/// users write.
const IntegratorKind& integrator_kind(RenderDesc::Integrator integrator);

/// What light is rendered: that requested, else all that the integrator can render only as a whole.
RenderDesc::Scattering scattering_of(const RenderDesc& render);

/// The rays per pixel requested, else as many as the integrator needs.
int samples_of(const RenderDesc& render);

/// Throws InputError for a scene that its integrator cannot render.
void check_integrator(const SceneDesc& scene);

}  // namespace uw
