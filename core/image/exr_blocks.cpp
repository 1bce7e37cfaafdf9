#include "core/image/exr_blocks.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <span>
#include <utility>

#include "core/base/vector_clones.h"
#include "core/image/deflate.h"
#include "core/image/half_float.h"

namespace uw {
namespace {

/// Every `stride`-th of `count` values as half floats.
UWVDB_VECTOR_CLONES void store_half(const float* values, std::size_t stride, std::size_t count,
                                    std::byte* out) {
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint16_t bits = half_bits(values[i * stride]);
        std::memcpy(out + sizeof(bits) * i, &bits, sizeof(bits));
    }
}

void store_float(const float* values, std::size_t stride, std::size_t count, std::byte* out) {
    for (std::size_t i = 0; i < count; ++i)
        std::memcpy(out + sizeof(float) * i, values + i * stride, sizeof(float));
}

/// What ZIP and ZIPS compress instead of the values: first the bytes at even places, then those at
/// odd ones, so that exponents stand together; each as its difference from the one before.
UWVDB_VECTOR_CLONES void store_differences(const std::byte* values, std::size_t count,
                                           std::byte* sorted, std::byte* out) {
    const std::size_t half = (count + 1) / 2;
    for (std::size_t i = 0; i < count / 2; ++i) {
        sorted[i] = values[2 * i];
        sorted[half + i] = values[2 * i + 1];
    }
    if (count % 2 == 1) sorted[half - 1] = values[count - 1];
    constexpr unsigned k_zero = 128;  // differences are stored with this added
    out[0] = sorted[0];
    for (std::size_t i = 1; i < count; ++i)
        out[i] = static_cast<std::byte>(static_cast<unsigned>(sorted[i]) -
                                        static_cast<unsigned>(sorted[i - 1]) + k_zero);
}

std::vector<std::byte> zipped(std::span<const std::byte> values) {
    std::vector<std::byte> sorted(values.size()), differences(values.size());
    store_differences(values.data(), values.size(), sorted.data(), differences.data());
    return zlib_stream(differences);
}

}  // namespace

ExrBlocks::ExrBlocks(const Film& film, const ExrHeader& header)
    : film_(film), compression_(header.compression) {
    for (const auto& [name, is_half] : header.channels) {
        const auto found = std::ranges::find(film.channel_names(), name);
        sources_.push_back(
            {static_cast<std::size_t>(found - film.channel_names().begin()), is_half});
        bytes_per_pixel_ += is_half ? sizeof(std::uint16_t) : sizeof(float);
    }
}

std::size_t ExrBlocks::count() const {
    const int lines = lines_per_block(compression_);
    return static_cast<std::size_t>((film_.window().height() + lines - 1) / lines);
}

// Line by line, within a line channel by channel.
std::vector<std::byte> ExrBlocks::values(int begin, int end) const {
    const auto width = static_cast<std::size_t>(film_.window().width());
    const std::size_t stride = film_.channel_names().size();
    std::vector<std::byte> bytes(static_cast<std::size_t>(end - begin) * width * bytes_per_pixel_);
    std::byte* at = bytes.data();
    for (int y = begin; y < end; ++y) {
        const float* const line = film_.pixel(film_.window().x0, y).data();
        for (const auto& [channel, is_half] : sources_) {
            if (is_half)
                store_half(line + channel, stride, width, at);
            else
                store_float(line + channel, stride, width, at);
            at += width * (is_half ? sizeof(std::uint16_t) : sizeof(float));
        }
    }
    return bytes;
}

std::vector<std::byte> ExrBlocks::encoded(std::size_t block) const {
    const PixelWindow& window = film_.window();
    const int lines = lines_per_block(compression_);
    const int begin = window.y0 + static_cast<int>(block) * lines;
    std::vector<std::byte> content = values(begin, std::min(begin + lines, window.y1));
    if (compression_ != ExrCompression::none) {
        std::vector<std::byte> compressed = zipped(content);
        // Readers recognise by its size a block that is stored as it is.
        if (compressed.size() < content.size()) content = std::move(compressed);
    }
    const std::array<std::int32_t, 2> head{begin, static_cast<std::int32_t>(content.size())};
    const auto head_bytes = std::as_bytes(std::span(head));
    content.insert(content.begin(), head_bytes.begin(), head_bytes.end());
    return content;
}

}  // namespace uw
