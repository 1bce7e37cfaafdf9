#include "core/image/png_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>

#include "core/image/deflate.h"

namespace uw {
namespace {

using Bytes = std::vector<std::byte>;

constexpr std::string_view k_signature = "\x89PNG\r\n\x1a\n";
constexpr std::size_t k_longest_keyword = 79;
/// Of the image's lines compressed together.
constexpr std::size_t k_part_bytes = std::size_t{1} << 18;

void append(Bytes& bytes, std::string_view text) {
    const auto raw = std::as_bytes(std::span(text));
    bytes.insert(bytes.end(), raw.begin(), raw.end());
}

void append_number(Bytes& bytes, std::uint32_t number) {
    for (const int shift : {24, 16, 8, 0})
        bytes.push_back(static_cast<std::byte>(number >> shift & 0xff));
}

void append_chunk(Bytes& file, std::string_view type, std::span<const std::byte> content) {
    append_number(file, static_cast<std::uint32_t>(content.size()));
    const std::size_t begin = file.size();
    append(file, type);
    file.insert(file.end(), content.begin(), content.end());
    append_number(file, crc32_of(std::span(file).subspan(begin)));
}

Bytes header_of(const Preview& image) {
    Bytes header;
    append_number(header, static_cast<std::uint32_t>(image.width()));
    append_number(header, static_cast<std::uint32_t>(image.height()));
    // 8 bits, RGB; the only compression, the only set of filters, not interlaced.
    for (const int value : {8, 2, 0, 0, 0}) header.push_back(static_cast<std::byte>(value));
    return header;
}

void append_text(Bytes& file, std::string_view keyword, std::string_view text) {
    Bytes content;
    append(content, keyword.substr(0, k_longest_keyword));
    const bool is_ascii = std::ranges::all_of(text, [](char c) { return c >= 0; });
    // The plain kind is Latin-1. The other has five bytes between: the end of the keyword, no
    // compression by no method, no language and no translated keyword.
    content.resize(content.size() + (is_ascii ? 1 : 5));
    append(content, text);
    append_chunk(file, is_ascii ? "tEXt" : "iTXt", content);
}

/// Every line as its difference from the one above.
Bytes filtered(const Preview& image) {
    constexpr std::byte k_up{2};
    const std::size_t line = 3 * static_cast<std::size_t>(image.width());
    Bytes bytes((line + 1) * static_cast<std::size_t>(image.height()));
    const std::vector<std::uint8_t> black(line);
    const std::uint8_t* above = black.data();
    std::byte* out = bytes.data();
    for (int y = 0; y < image.height(); ++y) {
        const std::uint8_t* const values = image.row(y).front().data();
        *out++ = k_up;
        for (std::size_t i = 0; i < line; ++i)
            *out++ = static_cast<std::byte>(static_cast<unsigned>(values[i]) - above[i]);
        above = values;
    }
    return bytes;
}

}  // namespace

std::vector<std::byte> encoded_png(const Preview& image, const ImageMetadata& metadata) {
    static_assert(sizeof(Srgb8) == 3);
    Bytes file;
    append(file, k_signature);
    append_chunk(file, "IHDR", header_of(image));
    append_chunk(file, "sRGB", Bytes{std::byte{0}});  // perceptual rendering intent
    for (const auto& [name, value] : metadata) {
        const auto* text = std::get_if<std::string>(&value);
        append_text(file, name, text ? *text : fmt::format("{:.6g}", std::get<double>(value)));
    }
    append_chunk(file, "IDAT", zlib_stream_in_parts(filtered(image), k_part_bytes));
    append_chunk(file, "IEND", {});
    return file;
}

}  // namespace uw
