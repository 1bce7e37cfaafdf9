#pragma once

#include <optional>

#include "core/base/output_files.h"
#include "core/image/colour_view.h"
#include "core/image/film.h"
#include "core/image/pixel_image.h"

namespace uw {

/// How an image becomes a picture.
struct PictureOptions {
    double exposure = 1;        // R, G and B are multiplied by it
    std::optional<int> bits{};  // per channel, at most the format's; none: the format's usual ones
    const ColourView* view = nullptr;  // null: sRGB
};

/// Writes R, G and B as they are to be seen (make_preview), in the format of pictures that the
/// ending of the file's name stands for (output_format). `metadata` is stored where the format has
/// a place for it, with the exposure and the view. The same picture gives the same bytes.
/// Precondition: it is such a format. Throws IoError, UsageError for a format that needs a module
/// which is not there, and Interrupted; what cannot be written is for out.commit() to report.
void write_picture(OutputFile& out, const Film& film, const PictureOptions& options,
                   const ImageMetadata& metadata);

/// Writes R, G and B as they are, in 32-bit floats with alpha or, in Radiance HDR, with a common
/// exponent and without; there negative values become 0. Throws as write_picture; precondition: a
/// format that holds light and has a writer.
void write_light(OutputFile& out, const Film& film, const ImageMetadata& metadata);

}  // namespace uw
