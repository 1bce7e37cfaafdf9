#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/base/output_files.h"
#include "core/image/pixel_image.h"

namespace uw {

/// The formats of image files, and those that OpenImageIO decodes and encodes for us, in a module
/// that is loaded when the first such image is met: all but OpenEXR, PNG and JPEG.

/// A format that is read, by what it is called and by OpenImageIO's name of its reader.
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

/// A format that images are written in. A picture is what is to be seen, in whole numbers of 8 or
/// 16 bits; light is R, G and B as they are, in floating point.
struct OutputFormat {
    const char* name;
    std::array<std::string_view, 2> endings;  // lower case; the second may be empty
    enum class Holds { pictures, light, either } holds;
    enum class Library { openexr, libpng, libjpeg, openimageio } library;
    const char* writer = nullptr;       // OpenImageIO's name of it
    int usual_bits = 8, most_bits = 8;  // per channel of a picture
};

/// The format that the ending of a file's name stands for, in upper or lower case; null if none.
const OutputFormat* output_format(const std::filesystem::path& file);

/// The endings of all of them, for messages: ".exr, .png, ...".
std::string output_endings();

/// The values of an image that is to be encoded: row by row, channels interleaved.
struct ImageValues {
    int width = 0, height = 0, channels = 3;
    enum class Type : std::uint8_t { u8, u16, f32 } type = Type::u8;
    const void* values = nullptr;
    bool is_srgb = false;               // how values encode light, if files are to say so
    std::string software, description;  // of those files that have a place for them
};

/// Throws UsageError if the module that writes `format` is not there.
void require_writer(const OutputFormat& format);

/// Writes all of a file of a format of OpenImageIO's. Throws UsageError if there is no module,
/// IoError if OpenImageIO refuses, and Interrupted; what cannot be written is for out.commit() to
/// report.
void write_other_image(OutputFile& out, const OutputFormat& format, const ImageValues& image);

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

/// read_other_image by this function of a module. Throws InputError.
PixelImage decode_other_image(DecodeImage& decode, std::span<const std::byte> encoded,
                              const ImageFormat& format, const std::string& name);

/// What the module exports as k_encode_image: writes an image to the file `path`, whatever its
/// ending.
using EncodeImage = void(const ImageValues& image, const char* writer, const char* path,
                         const std::function<bool()>& is_stopped, std::string& fault);
inline constexpr const char* k_encode_image = "uwvdb_encode_image_1";

}  // namespace uw
