#pragma once

#include <filesystem>

#include "core/files/output_file.h"
#include "core/image/digital_image.h"
#include "core/image/exr_options.h"
#include "core/image/film.h"
#include "core/image/image_metadata.h"
#include "core/image/preview.h"

namespace uw {

/// Writes the film as one OpenEXR part, by scanlines. The film's window is the data window, the
/// whole image the display window. The file appears under its name only once it is complete; the
/// same film, metadata and options give the same bytes, so no date is stored. Throws IoError;
/// Interrupted, as everything here does that writes many pixels, and then there is no new file.
void write_exr(const std::filesystem::path& file, const Film& film, const ImageMetadata& metadata,
               const ExrOptions& options = {});
/// All of that file, for `out` to be committed.
void write_exr(OutputFile& out, const Film& film, const ImageMetadata& metadata,
               const ExrOptions& options = {});

/// Writes an sRGB PNG of 8 or 16 bits; metadata as text chunks. The file appears under its name
/// only once it is complete. Throws IoError. `write_png_file` writes to an OutputFile.
void write_png(const std::filesystem::path& file, const Preview& image,
               const ImageMetadata& metadata);
void write_png(const std::filesystem::path& file, const Preview16& image,
               const ImageMetadata& metadata);

/// The same of a camera's image.
void write_png(const std::filesystem::path& file, const DigitalImage& image,
               const ImageMetadata& metadata);

/// A number of the metadata as a PNG states it: rounded to 6 digits.
double as_stated_in_png(double value);

}  // namespace uw
