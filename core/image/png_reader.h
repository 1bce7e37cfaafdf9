#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "core/image/pixel_image.h"

namespace uw {

/// A PNG in memory; messages call it `name`. Palettes are resolved: one channel is grey, two are
/// grey and alpha, three RGB, four RGBA. Throws InputError.
PixelImage read_png(std::span<const std::byte> encoded, const std::string& name);

}  // namespace uw
