#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>

#include "core/image/pixel_image.h"

namespace uw {

/// The formats of images other than PNG and JPEG. OpenImageIO decodes them, in a module that is
/// loaded when the first such image is met.

/// A format, by what it is called and by OpenImageIO's name of its reader.
struct ImageFormat {
    const char* name;
    const char* reader;
};

/// The format that the first bytes of a file tell; TGA, which has none, by the ending of `name`.
/// None if it is not known.
std::optional<ImageFormat> other_image_format(std::span<const std::byte> encoded,
                                              const std::string& name);

/// Whether `file` has the ending of a format that read_image knows.
bool has_ending_of_image(const std::filesystem::path& file);

/// Decodes an image; messages call it `name`. Floating-point values are linear and clamped to 0..1.
/// Throws InputError if it is damaged, too large, or if there is no module.
PixelImage read_other_image(std::span<const std::byte> encoded, const ImageFormat& format,
                            const std::string& name);

/// What the module asks the program for.
struct ImageReceiver {
    /// Makes room for an image; returns where its pixels go. May throw.
    std::function<float*(int width, int height, int channels, bool is_linear)> allocate;
    std::function<bool()> is_stopped;  // asked now and then
};

/// What the module exports as k_decode_image. `fault` becomes what is wrong with the image, if
/// anything is.
using DecodeImage = void(std::span<const std::byte> encoded, const char* reader,
                         const ImageReceiver& receiver, std::string& fault);
inline constexpr const char* k_decode_image = "uwvdb_decode_image_1";

}  // namespace uw
