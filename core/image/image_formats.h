#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/base/output_files.h"
#include "core/image/pixel_image.h"

namespace uw {

/// The formats of image files, and those that OpenImageIO decodes and encodes for us, in a module
/// that is loaded when the first such image is met: all but OpenEXR, PNG and JPEG. Parts of a large
/// OpenEXR are read by it, too.

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

/// What becomes of an image's values: those of colours are clamped to 0..1, and 0 for NaN; those of
/// light or lengths stay as they are, and may be anything.
enum class ImageRange { unit, any };

/// Decodes an OpenEXR, or another image by the module; messages call it `name`. Floating-point
/// values are linear. Throws InputError if it is damaged, too large, or if there is no module.
PixelImage read_other_image(std::span<const std::byte> encoded, const ImageFormat& format,
                            const std::string& name, ImageRange range = ImageRange::unit);

/// An image that is read in parts, when they are needed, since all of it would fill the memory.
/// Threads may read at once.
class PartialImage {
  public:
    PartialImage() = default;
    virtual ~PartialImage() = default;
    PartialImage(const PartialImage&) = delete;
    PartialImage& operator=(const PartialImage&) = delete;
    PartialImage(PartialImage&&) = delete;
    PartialImage& operator=(PartialImage&&) = delete;

    /// The pixels of columns x0 to x1 - 1 and rows y0 to y1 - 1, as in PixelImage, but as they are
    /// in the file: floating-point values may be anything. False if they cannot be read.
    virtual bool read(int x0, int y0, int x1, int y1, float* values) const = 0;
    /// All pixels, lines y0 to y1 - 1 at a time, from the top. False if the file is damaged.
    using Receive = std::function<void(int y0, int y1, const float* values)>;
    virtual bool read_all(const Receive& receive) const = 0;

    int width = 0, height = 0, channels = 0;
    bool is_linear = false;  // as of a PixelImage
};

/// The most pixels of an image that is read as a whole, where parts of it can be read.
inline constexpr std::int64_t k_max_whole_pixels = std::int64_t{1} << 26;

/// A TIFF or OpenEXR of more than `max_whole` pixels; null for other files. Throws InputError if
/// it is damaged, has more than 2^33 pixels or more than its bytes can hold; IoError.
std::shared_ptr<const PartialImage> open_partial_image(const std::filesystem::path& file,
                                                       std::int64_t max_whole = k_max_whole_pixels);

/// A format that images are written in. A picture is what is to be seen, in whole numbers of 8 or
/// 16 bits; light is R, G and B as they are, in floating point.
struct OutputFormat {
    const char* name;
    std::array<std::string_view, 2> endings;  // lower case; the second may be empty
    enum class Holds { pictures, light, either } holds;
    enum class Library { openexr, libpng, libjpeg, openimageio } library;
    const char* writer = nullptr;      // OpenImageIO's name of it
    int usual_bits = 8, max_bits = 8;  // per channel of a picture
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

/// What the module exports as k_open_parts: opens the image in the file `path`, whatever its
/// ending.
using OpenParts = void(const char* path, const char* reader,
                       std::shared_ptr<const PartialImage>& image, std::string& fault);
inline constexpr const char* k_open_parts = "uwvdb_open_parts_1";

/// read_other_image by this function of a module. Throws InputError.
PixelImage decode_other_image(DecodeImage& decode, std::span<const std::byte> encoded,
                              const ImageFormat& format, const std::string& name,
                              ImageRange range = ImageRange::unit);

/// What the module exports as k_encode_image: writes an image to the file `path`, whatever its
/// ending.
using EncodeImage = void(const ImageValues& image, const char* writer, const char* path,
                         const std::function<bool()>& is_stopped, std::string& fault);
inline constexpr const char* k_encode_image = "uwvdb_encode_image_1";

}  // namespace uw
