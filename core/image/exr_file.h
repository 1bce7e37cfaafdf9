#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "core/files/output_file.h"
#include "core/image/exr_options.h"
#include "core/image/film.h"
#include "core/image/image_metadata.h"

namespace uw {

/// The header of an OpenEXR file of one part, stored by scanlines from the top.
struct ExrHeader {
    int width = 0, height = 0;         // of the whole image, the display window
    PixelWindow window;                // of the pixels stored, the data window
    std::vector<ExrChannel> channels;  // sorted by name
    ExrCompression compression = ExrCompression::zip;
    ImageMetadata metadata;
};

/// Writes all of an EXR with the film's pixels, on all permitted threads, of whose number its bytes
/// are independent. The film has each channel of `header`, and its window. Throws IoError if
/// OpenEXR refuses, and Interrupted; what cannot be written is for out.commit() to report.
void write_exr_file(OutputFile& out, const Film& film, const ExrHeader& header);

/// The header of a file; empty if it cannot be read or is not one that `write_exr_file` could have
/// written.
std::optional<ExrHeader> read_exr_header(const std::filesystem::path& file);

}  // namespace uw
