#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace uw {

/// An image of whole numbers, as cameras store them: grey or red, green and blue, row by row,
/// channels interleaved.
struct DigitalImage {
    int width = 0, height = 0;
    int channels = 1;      // or 3
    int bits = 8;          // or 16
    bool is_srgb = false;  // how values encode light, if files are to say so
    std::vector<std::uint16_t> values;

    std::size_t row_values() const {
        return static_cast<std::size_t>(width) * static_cast<std::size_t>(channels);
    }
};

}  // namespace uw
