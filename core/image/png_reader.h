#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>

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

}  // namespace uw
