#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <variant>

#include "core/image/film.h"
#include "core/image/preview.h"

namespace uw {

/// Header metadata by name. Numbers are stored as 32-bit floats in EXR, as text in PNG.
using ImageMetadata = std::map<std::string, std::variant<std::string, double>>;

/// Writes the film as one OpenEXR part: every channel 32-bit float, scanlines, zip compression. The
/// film's window is the data window, the whole image the display window. The file appears under its
/// name only once it is complete; the same film and metadata give the same bytes, so no date is
/// stored. Throws IoError.
void write_exr(const std::filesystem::path& file, const Film& film, const ImageMetadata& metadata);

/// Writes an 8-bit sRGB PNG; metadata as text chunks. The file appears under its name only once it
/// is complete. Throws IoError.
void write_png(const std::filesystem::path& file, const Preview& image,
               const ImageMetadata& metadata);

}  // namespace uw
