#pragma once

#include "core/base/output_files.h"
#include "core/image/deep_image.h"
#include "core/image/exr_file.h"

namespace uw {

/// Writes a deep OpenEXR, by scanlines: R, G, B, A, Z and ZBack of the pixels of `window`, which is
/// within the image's. All are 32-bit floats: alphas near 1 and light far behind them need more
/// than half floats hold. `compression` other than none is zips, the closest one that deep images
/// have. Throws as write_exr_file.
void write_deep_exr_file(OutputFile& out, const DeepImage& image, const PixelWindow& window,
                         const ImageMetadata& metadata, ExrCompression compression);

}  // namespace uw
