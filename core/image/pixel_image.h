#pragma once

#include <vector>

namespace uw {

/// A decoded image: row-major, top row first, channels interleaved. 8- and 16-bit values are scaled
/// to 0..1; no transfer function is undone and alpha is not premultiplied.
struct PixelImage {
    int width = 0, height = 0, channels = 0;
    std::vector<float> pixels;  // width * height * channels
};

}  // namespace uw
