#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/image/exr_options.h"
#include "core/image/film.h"
#include "core/image/image_metadata.h"
#include "core/image/pixel_image.h"

namespace uw {

/// Reads a PNG or JPEG file. Throws IoError if it cannot be opened, InputError if it is neither, is
/// truncated or damaged, or is larger than 2^28 pixels.
PixelImage read_image(const std::filesystem::path& file);

/// The same for an image in memory; messages call it `name`. Throws InputError.
PixelImage read_image(std::span<const std::byte> encoded, const std::string& name);

/// The layout of an image file, without its pixels.
struct ImageLayout {
    int width = 0, height = 0;  // of the whole image
    PixelWindow window;         // of the pixels stored
    std::vector<std::string> channel_names;
    ExrOptions storage{};
};

/// Whether the header of `file` is that of an image written by write_exr with this layout and all
/// of `metadata`. False if it cannot be read.
bool has_header_of(const std::filesystem::path& file, const ImageLayout& layout,
                   const ImageMetadata& metadata);

/// The exposure and the bits per channel that a PNG written by write_png states. None if it cannot
/// be read.
struct PreviewHeader {
    double exposure = 1;
    int bits = 8;
};
std::optional<PreviewHeader> read_preview_header(const std::filesystem::path& file);

}  // namespace uw
