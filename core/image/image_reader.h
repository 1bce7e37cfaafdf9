#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/image/film.h"
#include "core/image/image_writer.h"

namespace uw {

/// A decoded picture: row-major, top row first, channels interleaved. 8 and 16 bit values are
/// scaled to 0..1; no transfer curve is undone and alpha is not multiplied in.
struct PixelImage {
    int width = 0, height = 0, channels = 0;
    std::vector<float> pixels;  // width * height * channels
};

/// Reads any picture that OpenImageIO knows. Throws IoError if the file cannot be opened,
/// InputError if it is no picture, is cut off, or is larger than 2^28 pixels.
PixelImage read_image(const std::filesystem::path& file);

/// The same for a PNG or JPEG in memory; `name` stands in messages. Throws InputError.
PixelImage read_image(std::span<const std::byte> encoded, const std::string& name);

/// How an image's file is laid out, apart from its pixels.
struct ImageLayout {
    int width = 0, height = 0;  // of the whole image
    PixelWindow window;         // of the pixels stored
    std::vector<std::string> channel_names;
};

/// Whether the header of `file` is that of an image written by write_exr, of that layout and with
/// all of `metadata`. False for what cannot be read.
bool has_header_of(const std::filesystem::path& file, const ImageLayout& layout,
                   const ImageMetadata& metadata);

}  // namespace uw
