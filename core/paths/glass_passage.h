#pragma once

#include <optional>

#include "core/base/random.h"
#include "core/base/ray.h"
#include "core/base/spectrum.h"
#include "core/geometry/surfaces.h"
#include "core/light/integrator.h"

namespace uw {

/// Follows a ray from the glass that it meets at `hit` until it is back in the water: at each
/// surface it is reflected or refracted at random, in proportion to the light that either brings to
/// `throughput` times `factor`. Multiplies `factor`, by band, by what is left over the probability.
/// Nothing if it does not come back: what lies in the glass itself ends it.
std::optional<Ray> sample_glass_passage(const LitScene& scene, const Ray& ray, SurfaceHit hit,
                                        const Spectrum& throughput, PathRandom& random,
                                        Spectrum& factor);

}  // namespace uw
