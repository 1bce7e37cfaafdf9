#include <span>

#include "core/image/image_file.h"
#include "core/image/pixel_image.h"
#include "tests/fuzz/fuzzing.h"

// PNG, JPEG and OpenEXR through the door by which textures come in: values are within 0..1.
UWVDB_FUZZ(data, size) {
    using namespace uw;
    fuzz::parse([&] {
        const PixelImage image = read_image(std::as_bytes(std::span(data, size)), "texture");
        for (const float value : image.pixels)
            if (!(value >= 0 && value <= 1)) __builtin_trap();
    });
    return 0;
}
