#pragma once

#include "core/light/surface_lighting.h"

namespace uw {

/// The relative intensity of an emitter towards a surface sample; of one that stands for a part of
/// a lamp and has a profile with an edge, the mean over that part. By its point alone, each point
/// of the lamp would draw an edge of its own, and all of them steps and lobes in place of a soft
/// edge. The samples of a pixel cover the part evenly, as those of shadow_origin.
double relative_intensity_towards(const Lamp& emitter, const SurfaceSample& sample);

}  // namespace uw
