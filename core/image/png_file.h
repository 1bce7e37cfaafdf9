#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>

#include "core/base/output_files.h"
#include "core/image/pixel_image.h"

namespace uw {

/// A PNG in memory; messages call it `name`. Palettes are resolved: one channel is grey, two are
/// grey and alpha, three RGB, four RGBA. Throws InputError.
PixelImage read_png(std::span<const std::byte> encoded, const std::string& name);

/// What a PNG says of itself.
struct PngHeader {
    int bits = 8;                              // per channel
    std::map<std::string, std::string> texts;  // those before the pixels
};

/// None if the file cannot be read.
std::optional<PngHeader> read_png_header(const std::filesystem::path& file);

/// Writes all of a PNG of 8 or 16 bits, with metadata as its texts; `is_srgb`: it says that it is
/// sRGB. Throws IoError if libpng refuses, and Interrupted; what cannot be written is for
/// out.commit() to report.
void write_png_file(OutputFile& out, const Preview& image, const ImageMetadata& metadata,
                    bool is_srgb = true);
void write_png_file(OutputFile& out, const Preview16& image, const ImageMetadata& metadata,
                    bool is_srgb = true);
/// Writes the image that a camera stores in the same way; the file says that it is sRGB if it is.
void write_png_file(OutputFile& out, const DigitalImage& image, const ImageMetadata& metadata);

/// What a number of the metadata is as a text.
std::string png_number(double value);

}  // namespace uw
