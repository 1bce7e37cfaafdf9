#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "core/image/pixel_image.h"

namespace uw {

/// A JPEG in memory; messages call it `name`. One channel is grey, three are RGB, to which CMYK is
/// converted. Throws InputError, also if it is truncated.
PixelImage read_jpeg(std::span<const std::byte> encoded, const std::string& name);

}  // namespace uw
