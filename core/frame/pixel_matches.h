#pragma once

#include <span>

#include "core/frame/pixel_layers.h"
#include "core/frame/pixel_view.h"
#include "core/frame/point_matcher.h"

namespace uw {

/// Looks for the points at the centres of neighbouring pixels in the other images: sets
/// PixelView::matches of the views that have one.
void find_matches(const PointMatchers& matchers, std::span<PixelView> views);

/// Makes of them flow and disparity. Precondition: the view has a point, and its matches were
/// found.
void store_matches(const PointMatchers& matchers, const PixelView& view, PixelResult& result);

}  // namespace uw
