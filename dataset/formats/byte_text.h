#pragma once

#include <bit>
#include <cstddef>
#include <cstring>
#include <span>
#include <string>

namespace uw {

static_assert(std::endian::native == std::endian::little);

/// Appends a number as its bytes, little-endian.
template <class T>
void append_bytes(std::string& text, const T& value) {
    text.append(reinterpret_cast<const char*>(&value), sizeof(value));
}

/// Appends 32-bit floats, little-endian.
inline void append_floats(std::string& text, std::span<const float> values) {
    text.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
}

}  // namespace uw
