#pragma once

#include "core/light/integrator_kind.h"

namespace uw {

/// The requirements, checks and factory of an integrator; k_integrator_names holds the names that
/// users write.
const IntegratorKind& integrator_kind(RenderDesc::Integrator integrator);

/// Which light is rendered: as requested; by default all light if the integrator traces paths,
/// light that is scattered once if it renders no other, and else what the scene's version has by
/// default.
RenderDesc::Scattering scattering_of(const RenderDesc& render);

/// The rays per pixel that are requested, or by default those that the integrator needs.
int samples_of(const RenderDesc& render);

/// Throws InputError for a scene that its integrator cannot render.
void check_integrator(const SceneDesc& scene);

}  // namespace uw
