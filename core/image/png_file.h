#pragma once

#include <cstddef>
#include <vector>

#include "core/image/image_metadata.h"
#include "core/image/preview.h"

namespace uw {

/// A whole PNG file (ISO/IEC 15948) of 8-bit sRGB, with metadata as its texts.
std::vector<std::byte> encoded_png(const Preview& image, const ImageMetadata& metadata);

}  // namespace uw
