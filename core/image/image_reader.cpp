#include "core/image/image_reader.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <variant>

#include "core/base/error.h"

namespace uw {
namespace {

constexpr std::int64_t k_max_pixels = std::int64_t{1} << 28;
constexpr int k_max_channels = 64;
// No codec in use packs more values than this into a byte (deflate: 1032), so that a forged size
// in the header of a small file does not allocate gigabytes.
constexpr std::int64_t k_max_values_per_byte = 4096;

std::string first_line(const std::string& text) {
    return text.substr(0, text.find('\n'));
}

PixelImage decode(OIIO::ImageInput& input, const std::string& name, std::int64_t encoded_size) {
    const OIIO::ImageSpec& spec = input.spec();
    if (spec.width < 1 || spec.height < 1 || spec.depth > 1 || spec.nchannels < 1 ||
        spec.nchannels > k_max_channels) {
        throw InputError(name + ": not a plain two-dimensional image; save it as PNG");
    }
    const std::int64_t pixels = std::int64_t{spec.width} * spec.height;
    if (pixels > k_max_pixels) {
        throw InputError(
            fmt::format("{}: {} x {} pixels are more than the 2^28 supported; "
                        "scale the image down",
                        name, spec.width, spec.height));
    }
    if (pixels * spec.nchannels / k_max_values_per_byte > encoded_size) {
        throw InputError(
            fmt::format("{}: {} bytes cannot hold {} x {} pixels; the file is truncated", name,
                        encoded_size, spec.width, spec.height));
    }
    PixelImage image{spec.width, spec.height, spec.nchannels, {}};
    image.pixels.resize(static_cast<std::size_t>(pixels * spec.nchannels));
    if (!input.read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, image.pixels.data())) {
        throw InputError(
            fmt::format("{}: cannot decode the image: {}", name, first_line(input.geterror())));
    }
    return image;
}

OIIO::ImageSpec reading_options() {
    OIIO::ImageSpec options;
    options.attribute("oiio:UnassociatedAlpha", 1);
    return options;
}

/// A file name with the extension of the format indicated by the first bytes; empty if it is
/// neither PNG nor JPEG.
std::string format_hint(std::span<const std::byte> encoded) {
    const auto starts_with = [&](std::initializer_list<int> magic) {
        return encoded.size() >= magic.size() &&
               std::equal(magic.begin(), magic.end(), encoded.begin(),
                          [](int a, std::byte b) { return a == std::to_integer<int>(b); });
    };
    if (starts_with({0x89, 'P', 'N', 'G'})) return "memory.png";
    if (starts_with({0xff, 0xd8, 0xff})) return "memory.jpg";
    return "";
}

}  // namespace

PixelImage read_image(const std::filesystem::path& file) {
    std::error_code status;
    // A pipe or device under an image's name would block the reader.
    if (!std::filesystem::is_regular_file(file, status)) {
        throw IoError(file.string() + ": no such image file; check the name");
    }
    const auto size = static_cast<std::int64_t>(std::filesystem::file_size(file, status));
    const OIIO::ImageSpec options = reading_options();
    const auto input = OIIO::ImageInput::open(file.string(), &options);
    if (!input) {
        throw InputError(fmt::format("{}: cannot read the image: {}", file.string(),
                                     first_line(OIIO::geterror())));
    }
    return decode(*input, file.string(), size);
}

PixelImage read_image(std::span<const std::byte> encoded, const std::string& name) {
    const std::string hint = format_hint(encoded);
    if (hint.empty()) {
        throw InputError(name + ": neither PNG nor JPEG; save the image as one of these");
    }
    OIIO::Filesystem::IOMemReader memory(encoded.data(), encoded.size());
    OIIO::ImageSpec options = reading_options();
    // Through the options: given both, OpenImageIO 2.4 forgets a reader passed as an argument.
    OIIO::Filesystem::IOProxy* proxy = &memory;
    options.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
    const auto input = OIIO::ImageInput::open(hint, &options);
    if (!input) {
        throw InputError(
            fmt::format("{}: cannot read the image: {}", name, first_line(OIIO::geterror())));
    }
    return decode(*input, name, static_cast<std::int64_t>(encoded.size()));
}

bool has_header_of(const std::filesystem::path& file, const ImageLayout& layout,
                   const ImageMetadata& metadata) {
    std::error_code status;
    if (!std::filesystem::is_regular_file(file, status)) return false;
    const auto input = OIIO::ImageInput::open(file.string());
    if (!input) {
        static_cast<void>(OIIO::geterror());  // or it would be printed when the program ends
        return false;
    }
    const OIIO::ImageSpec& spec = input->spec();
    const PixelWindow window{spec.x, spec.y, spec.x + spec.width, spec.y + spec.height};
    // Readers may reorder the channels.
    if (window != layout.window || spec.full_width != layout.width ||
        spec.full_height != layout.height ||
        !std::ranges::is_permutation(spec.channelnames, layout.channel_names))
        return false;
    return std::ranges::all_of(metadata, [&](const auto& entry) {
        const auto& [name, value] = entry;
        if (const auto* text = std::get_if<std::string>(&value))
            return spec.get_string_attribute(name) == *text;
        return spec.get_float_attribute(name, -1.0F) == static_cast<float>(std::get<double>(value));
    });
}

}  // namespace uw
