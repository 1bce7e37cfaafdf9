#pragma once

#include <filesystem>

#include "core/image/digital_image.h"
#include "core/image/exr_options.h"
#include "core/image/film.h"
#include "core/image/image_metadata.h"
#include "core/image/preview.h"

namespace uw {

/// Writes the film as one OpenEXR part, by scanlines. The film's window is the data window, the
/// whole image the display window. The file appears under its name only once it is complete; the
/// same film, metadata and options give the same bytes, so no date is stored. Throws IoError.
void write_exr(const std::filesystem::path& file, const Film& film, const ImageMetadata& metadata,
               const ExrOptions& options = {});

/// Writes an sRGB PNG of 8 or 16 bits; metadata as text chunks. The file appears under its name
/// only once it is complete. Throws IoError.
void write_png(const std::filesystem::path& file, const Preview& image,
               const ImageMetadata& metadata);
void write_png(const std::filesystem::path& file, const Preview16& image,
               const ImageMetadata& metadata);

/// The same of a camera's image, as PNG or as JPEG of a quality of 1..100, which needs 8 bits.
void write_png(const std::filesystem::path& file, const DigitalImage& image,
               const ImageMetadata& metadata);
void write_jpeg(const std::filesystem::path& file, const DigitalImage& image, int quality,
                const ImageMetadata& metadata);

/// A number of the metadata as a PNG states it: rounded to 6 digits.
double as_stated_in_png(double value);

}  // namespace uw
