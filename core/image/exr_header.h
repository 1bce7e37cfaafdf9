#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/image/film.h"
#include "core/image/image_metadata.h"

namespace uw {

/// How the lines of an EXR are compressed, all without loss, by the format's own numbers: not at
/// all, by deflate each line by itself, or in blocks of 16.
enum class ExrCompression : std::uint8_t { none = 0, zips = 2, zip = 3 };

/// How many lines are compressed together.
constexpr int lines_per_block(ExrCompression compression) {
    return compression == ExrCompression::zip ? 16 : 1;
}

struct ExrChannel {
    std::string name;
    bool is_half = false;  // else a 32-bit float

    friend bool operator==(const ExrChannel&, const ExrChannel&) = default;
};

/// The header of an OpenEXR file of one part, stored by scanlines from the top.
struct ExrHeader {
    int width = 0, height = 0;         // of the whole image, the display window
    PixelWindow window;                // of the pixels stored, the data window
    std::vector<ExrChannel> channels;  // sorted by name, as the format demands
    ExrCompression compression = ExrCompression::zip;
    ImageMetadata metadata;
};

/// Everything in the file before the table of its blocks (OpenEXR File Layout, version 2).
std::string encoded(const ExrHeader& header);

/// The header of a file; empty if it cannot be read or is not one that `encoded` could have made.
std::optional<ExrHeader> read_exr_header(const std::filesystem::path& file);

}  // namespace uw
