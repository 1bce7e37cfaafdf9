#include "core/image/exr_header.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <fstream>
#include <limits>
#include <string_view>
#include <type_traits>

namespace uw {
namespace {

static_assert(std::endian::native == std::endian::little, "EXR is little-endian, and so is this");

constexpr std::string_view k_magic = "\x76\x2f\x31\x01";
constexpr std::uint32_t k_version = 2, k_long_names = 0x400;
constexpr std::size_t k_longest_short_name = 31;
constexpr std::int32_t k_half = 1, k_float = 2;
// Far above what headers hold, so that a file of another kind is not read in full.
constexpr std::size_t k_most_header_bytes = std::size_t{1} << 20;

using Box = std::array<std::int32_t, 4>;

template <class T>
void append(std::string& bytes, const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    std::array<char, sizeof(T)> raw;
    std::memcpy(raw.data(), &value, sizeof(T));
    bytes.append(raw.data(), raw.size());
}

void append_name(std::string& bytes, std::string_view name) {
    bytes.append(name);
    bytes.push_back('\0');
}

void append_attribute(std::string& bytes, std::string_view name, std::string_view type,
                      std::string_view value) {
    append_name(bytes, name);
    append_name(bytes, type);
    append(bytes, static_cast<std::int32_t>(value.size()));
    bytes.append(value);
}

template <class T>
void append_attribute(std::string& bytes, std::string_view name, std::string_view type,
                      const T& value) {
    std::string raw;
    append(raw, value);
    append_attribute(bytes, name, type, std::string_view(raw));
}

std::string encoded(const std::vector<ExrChannel>& channels) {
    std::string bytes;
    for (const ExrChannel& channel : channels) {
        append_name(bytes, channel.name);
        append(bytes, channel.is_half ? k_half : k_float);
        append(bytes, std::int32_t{0});  // not perceptually linear, and three bytes unused
        append(bytes, std::array<std::int32_t, 2>{1, 1});  // a sample for every pixel
    }
    bytes.push_back('\0');
    return bytes;
}

Box box(int x0, int y0, int x1, int y1) {
    return {x0, y0, x1 - 1, y1 - 1};
}

bool has_long_names(const ExrHeader& header) {
    const auto is_long = [](const std::string& name) { return name.size() > k_longest_short_name; };
    return std::ranges::any_of(header.channels, is_long, &ExrChannel::name) ||
           std::ranges::any_of(header.metadata, is_long,
                               [](const auto& entry) { return entry.first; });
}

/// Takes values from the front of a header; empty where there is nothing left.
class Reader {
  public:
    explicit Reader(std::string_view bytes) : left_(bytes) {}

    std::optional<std::string_view> take(std::size_t count) {
        if (count > left_.size()) return std::nullopt;
        const std::string_view taken = left_.substr(0, count);
        left_.remove_prefix(count);
        return taken;
    }
    template <class T>
    std::optional<T> take() {
        const auto raw = take(sizeof(T));
        if (!raw) return std::nullopt;
        T value;
        std::memcpy(&value, raw->data(), sizeof(T));
        return value;
    }
    std::optional<std::string_view> take_name() {
        const std::size_t end = left_.find('\0');
        if (end == std::string_view::npos) return std::nullopt;
        const std::string_view name = left_.substr(0, end);
        left_.remove_prefix(end + 1);
        return name;
    }

  private:
    std::string_view left_;
};

std::optional<std::vector<ExrChannel>> decoded_channels(std::string_view bytes) {
    constexpr std::size_t k_rest = 12;  // linearity and sampling
    std::vector<ExrChannel> channels;
    for (Reader reader(bytes);;) {
        const auto name = reader.take_name();
        if (!name) return std::nullopt;
        if (name->empty()) return channels;
        const auto type = reader.take<std::int32_t>();
        if ((type != k_half && type != k_float) || !reader.take(k_rest)) return std::nullopt;
        channels.push_back({std::string(*name), type == k_half});
    }
}

std::optional<ExrCompression> decoded_compression(std::optional<std::uint8_t> code) {
    for (const auto known : {ExrCompression::none, ExrCompression::zips, ExrCompression::zip})
        if (code == static_cast<std::uint8_t>(known)) return known;
    return std::nullopt;
}

/// Adds an attribute to `header`; false if it is not what `encoded` writes under this name. Those
/// of no interest are passed over.
bool take_attribute(std::string_view name, std::string_view type, std::string_view value,
                    ExrHeader& header) {
    Reader reader(value);
    if (name == "channels") {
        auto channels = decoded_channels(value);
        if (channels) header.channels = std::move(*channels);
        return channels.has_value();
    }
    if (name == "compression") {
        const auto compression = decoded_compression(reader.take<std::uint8_t>());
        if (compression) header.compression = *compression;
        return compression.has_value();
    }
    if (type == "box2i") {
        const auto corners = reader.take<Box>();
        if (!corners) return false;
        const auto& [x0, y0, x1, y1] = *corners;
        if (std::max(x1, y1) == std::numeric_limits<std::int32_t>::max()) return false;
        if (name == "dataWindow") header.window = {x0, y0, x1 + 1, y1 + 1};
        if (name == "displayWindow") header.width = x1 + 1, header.height = y1 + 1;
        return true;
    }
    if (type == "string") header.metadata[std::string(name)] = std::string(value);
    if (type == "float") {
        const auto number = reader.take<float>();
        if (!number) return false;
        header.metadata[std::string(name)] = static_cast<double>(*number);
    }
    return true;
}

}  // namespace

std::string encoded(const ExrHeader& header) {
    const PixelWindow& window = header.window;
    std::string bytes(k_magic);
    append(bytes, has_long_names(header) ? k_version | k_long_names : k_version);
    append_attribute(bytes, "channels", "chlist", std::string_view(encoded(header.channels)));
    append_attribute(bytes, "compression", "compression", header.compression);
    append_attribute(bytes, "dataWindow", "box2i", box(window.x0, window.y0, window.x1, window.y1));
    append_attribute(bytes, "displayWindow", "box2i", box(0, 0, header.width, header.height));
    append_attribute(bytes, "lineOrder", "lineOrder", std::uint8_t{0});  // from the top
    append_attribute(bytes, "pixelAspectRatio", "float", 1.0F);
    append_attribute(bytes, "screenWindowCenter", "v2f", std::array<float, 2>{0, 0});
    append_attribute(bytes, "screenWindowWidth", "float", 1.0F);
    for (const auto& [name, value] : header.metadata) {
        if (const auto* text = std::get_if<std::string>(&value))
            append_attribute(bytes, name, "string", std::string_view(*text));
        else
            append_attribute(bytes, name, "float", static_cast<float>(std::get<double>(value)));
    }
    bytes.push_back('\0');
    return bytes;
}

std::optional<ExrHeader> read_exr_header(const std::filesystem::path& file) {
    std::error_code status;
    // A pipe or device under an image's name would block the reader.
    if (!std::filesystem::is_regular_file(file, status)) return std::nullopt;
    const std::size_t size = std::filesystem::file_size(file, status);
    std::string bytes(status ? 0 : std::min(size, k_most_header_bytes), '\0');
    std::ifstream in(file, std::ios::binary);
    if (!in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()))) return std::nullopt;

    Reader reader(bytes);
    if (reader.take(k_magic.size()) != k_magic) return std::nullopt;
    const auto version = reader.take<std::uint32_t>();
    if (!version || (*version & ~k_long_names) != k_version) return std::nullopt;
    ExrHeader header;
    for (;;) {
        const auto name = reader.take_name();
        if (!name) return std::nullopt;
        if (name->empty()) return header;
        const auto type = reader.take_name();
        const auto count = reader.take<std::int32_t>();
        if (!type || !count || *count < 0) return std::nullopt;
        const auto value = reader.take(static_cast<std::size_t>(*count));
        if (!value || !take_attribute(*name, *type, *value, header)) return std::nullopt;
    }
}

}  // namespace uw
