#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/image/film.h"
#include "core/image/image_writer.h"

namespace uw {

/// A decoded image: row-major, top row first, channels interleaved. 8- and 16-bit values are scaled
/// to 0..1; no transfer function is undone and alpha is not premultiplied.
struct PixelImage {
    int width = 0, height = 0, channels = 0;
    std::vector<float> pixels;  // width * height * channels
};

/// Reads any image format that OpenImageIO supports. Throws IoError if the file cannot be opened,
/// InputError if it is not an image, is truncated, or is larger than 2^28 pixels.
PixelImage read_image(const std::filesystem::path& file);

/// The same for a PNG or JPEG in memory; messages call it `name`. Throws InputError.
PixelImage read_image(std::span<const std::byte> encoded, const std::string& name);

/// The layout of an image file, without its pixels.
struct ImageLayout {
    int width = 0, height = 0;  // of the whole image
    PixelWindow window;         // of the pixels stored
    std::vector<std::string> channel_names;
};

/// Whether the header of `file` is that of an image written by write_exr with this layout and all
/// of `metadata`. False if it cannot be read.
bool has_header_of(const std::filesystem::path& file, const ImageLayout& layout,
                   const ImageMetadata& metadata);

}  // namespace uw
