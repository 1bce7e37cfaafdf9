#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace uw {

/// To be called before anything is allocated for an image whose header says so. Throws InputError
/// if it is larger than 2^28 pixels, than `encoded_bytes` can hold, or than what fits into free
/// memory; messages call it `name`.
void check_image_size(std::int64_t width, std::int64_t height, int channels,
                      std::size_t encoded_bytes, const std::string& name);

}  // namespace uw
