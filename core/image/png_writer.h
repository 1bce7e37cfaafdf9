#pragma once

#include <string>

#include "core/files/output_file.h"
#include "core/image/digital_image.h"
#include "core/image/image_metadata.h"
#include "core/image/preview.h"

namespace uw {

/// Writes all of a PNG of 8- or 16-bit sRGB, with metadata as its texts. Throws IoError if libpng
/// refuses, and Interrupted; what cannot be written is for out.commit() to report.
void write_png_file(OutputFile& out, const Preview& image, const ImageMetadata& metadata);
void write_png_file(OutputFile& out, const Preview16& image, const ImageMetadata& metadata);
/// The same of a camera's image; it says to be sRGB if the image is.
void write_png_file(OutputFile& out, const DigitalImage& image, const ImageMetadata& metadata);

/// What a number of the metadata is as a text.
std::string png_number(double value);

}  // namespace uw
