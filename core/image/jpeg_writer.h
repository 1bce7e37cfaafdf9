#pragma once

#include "core/files/output_file.h"
#include "core/image/digital_image.h"
#include "core/image/image_metadata.h"

namespace uw {

/// Writes all of a baseline JPEG of this quality, 1..100, with metadata as its comment, a line
/// "name: value" for each. Colour is stored at half the resolution, as libjpeg does unless told
/// otherwise. Precondition: 8 bits. Throws IoError if libjpeg refuses, and Interrupted; what
/// cannot be written is for out.commit() to report.
void write_jpeg_file(OutputFile& out, const DigitalImage& image, int quality,
                     const ImageMetadata& metadata);

}  // namespace uw
