#include "core/image/image_limits.h"

#include <fmt/format.h>

#include "core/base/available_memory.h"
#include "core/base/error.h"

namespace uw {

void check_image_size(std::int64_t width, std::int64_t height, int channels,
                      std::size_t encoded_bytes, const std::string& name) {
    constexpr std::int64_t k_max_pixels = std::int64_t{1} << 28;
    // No codec in use packs more values than this into a byte (deflate: 1032), so that a forged
    // size in the header of a small file does not allocate gigabytes.
    constexpr std::int64_t k_max_values_per_byte = 4096;
    if (width > k_max_pixels || height > k_max_pixels || width * height > k_max_pixels) {
        throw InputError(
            fmt::format("{}: {} x {} pixels are more than the 2^28 supported; "
                        "scale the image down",
                        name, width, height));
    }
    if (width * height * channels / k_max_values_per_byte >
        static_cast<std::int64_t>(encoded_bytes)) {
        throw InputError(
            fmt::format("{}: {} bytes cannot hold {} x {} pixels; the file is truncated", name,
                        encoded_bytes, width, height));
    }
    // A byte or two as the codec gives it, and a float.
    constexpr double k_bytes_per_value = 5;
    require_memory(k_bytes_per_value * static_cast<double>(width * height * channels),
                   fmt::format("{}: {} x {} pixels need", name, width, height),
                   "scale the image down");
}

}  // namespace uw
