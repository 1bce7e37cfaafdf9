#pragma once

#include <functional>

#include "cli/validate/validation_methods.h"

namespace uw {

/// Forward scatter of the light of surfaces (physics section 6; the paper's equations 14 and 16) in
/// uniform water, written out as a sum over all pairs of pixels: every pixel's light times the
/// closed form of its own kernel over every other pixel and its mirror images at the borders. No
/// transforms, no interpolated kernel widths, no float: shares nothing with ForwardPass but the
/// focal lengths in the water. Surfaces are lit by `lighting`. Cost: pixels^2. Throws Interrupted
/// if `proceed` returns false.
std::vector<Spectrum> forward_by_direct_sum(const TrialScene& trial,
                                            const SurfaceLighting& lighting,
                                            const std::function<bool()>& proceed);

}  // namespace uw
