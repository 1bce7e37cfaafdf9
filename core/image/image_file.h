#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/output_files.h"
#include "core/image/exr_file.h"
#include "core/image/film.h"
#include "core/image/pixel_image.h"

namespace uw {

/// The bytes of an image file, as read_image decodes them. Throws as open_input; InputError if it
/// is larger than 2 GB.
std::vector<std::byte> read_image_bytes(const std::filesystem::path& file);

/// Reads a PNG or JPEG file, or another by a module (core/image/image_formats.h). Throws as
/// open_input; InputError if it is none of these, is truncated or damaged, or is larger than 2^28
/// pixels.
PixelImage read_image(const std::filesystem::path& file);

/// The same for a picture that the program wrote itself and may write again (open_own_file).
PixelImage read_own_image(const std::filesystem::path& file);

/// The same for an image in memory; messages call it `name`. Throws InputError.
PixelImage read_image(std::span<const std::byte> encoded, const std::string& name);

/// Reads an image of light or lengths: OpenEXR, TIFF or Radiance HDR with linear floating-point
/// values, which are as they are in the file. Throws as read_image, and InputError for others.
PixelImage read_linear_image(const std::filesystem::path& file);

/// The layout of an image file, without its pixels.
struct ImageLayout {
    int width = 0, height = 0;  // of the whole image
    PixelWindow window;         // of the pixels stored
    std::vector<std::string> channel_names;
    ExrOptions storage{};
};

/// An image's metadata as they are in an EXR that is stored in this way.
ImageMetadata metadata_in(const ExrOptions& options, const ImageMetadata& metadata);

/// Whether the header of `file` is that of an image written by write_exr with this layout and all
/// of `metadata`. False if it cannot be read.
bool has_header_of(const std::filesystem::path& file, const ImageLayout& layout,
                   const ImageMetadata& metadata);

/// The exposure, the bits per channel and the view that a PNG written as a picture states. None if
/// it cannot be read.
struct PreviewHeader {
    double exposure = 1;
    int bits = 8;
    std::string view{};  // empty: sRGB
};
std::optional<PreviewHeader> read_preview_header(const std::filesystem::path& file);

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

/// Writes the image that a camera stores in the same way.
void write_png(const std::filesystem::path& file, const DigitalImage& image,
               const ImageMetadata& metadata);

/// A number of the metadata as a PNG states it: rounded to 6 digits.
double as_stated_in_png(double value);

}  // namespace uw
