#pragma once

#include "core/frame/pixel_layers.h"
#include "core/frame/pixel_view.h"
#include "core/frame/point_matcher.h"

namespace uw {

/// Looks for the point at a pixel's centre in the other images. Precondition: there is one.
void find_matches(const PointMatchers& matchers, const PixelView& view, PixelResult& result);

}  // namespace uw
