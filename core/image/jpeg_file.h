#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "core/base/output_files.h"
#include "core/image/pixel_image.h"

namespace uw {

/// A JPEG in memory; messages call it `name`. One channel is grey, three are RGB, to which CMYK is
/// converted. Throws InputError, also if it is truncated.
PixelImage read_jpeg(std::span<const std::byte> encoded, const std::string& name);

/// Writes all of a baseline JPEG of this quality, 1..100, with metadata as its comment, a line
/// "name: value" for each. Colour is stored at half the resolution, as libjpeg does unless told
/// otherwise. Precondition: 8 bits. Throws IoError if libjpeg refuses, and Interrupted; what
/// cannot be written is for out.commit() to report.
void write_jpeg_file(OutputFile& out, const DigitalImage& image, int quality,
                     const ImageMetadata& metadata);

}  // namespace uw
