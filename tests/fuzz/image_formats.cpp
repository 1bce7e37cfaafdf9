#include <cstddef>
#include <span>
#include <string>

#include "core/image/image_formats.h"
#include "core/image/pixel_image.h"
#include "tests/fuzz/fuzzing.h"

extern "C" uw::DecodeImage uwvdb_decode_image_1;

// The formats that OpenImageIO decodes, by the code that the module has: values are within 0..1.
// TGA has no mark of its own: what has none of the others' is read as that.
UWVDB_FUZZ(data, size) {
    using namespace uw;
    const auto encoded = std::as_bytes(std::span(data, size));
    fuzz::parse([&] {
        const auto format = other_image_format(encoded, "texture.tga");
        const PixelImage image =
            decode_other_image(uwvdb_decode_image_1, encoded, *format, "texture.tga");
        for (const float value : image.pixels)
            if (!(value >= 0 && value <= 1)) __builtin_trap();
    });
    return 0;
}
