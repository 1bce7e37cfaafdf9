#include "core/image/image_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <initializer_list>
#include <optional>
#include <variant>

#include "core/base/error.h"
#include "core/base/input_files.h"
#include "core/base/output_files.h"
#include "core/base/text.h"
#include "core/image/aces.h"
#include "core/image/exr_file.h"
#include "core/image/image_formats.h"
#include "core/image/jpeg_file.h"
#include "core/image/png_file.h"

namespace uw {

namespace {

// Far above what a texture of 2^28 pixels takes.
constexpr std::size_t k_max_bytes = std::size_t{1} << 31;

bool starts_with(std::span<const std::byte> encoded, std::initializer_list<int> magic) {
    return encoded.size() >= magic.size() &&
           std::equal(magic.begin(), magic.end(), encoded.begin(),
                      [](int a, std::byte b) { return a == std::to_integer<int>(b); });
}

/// `in`: the file, open.
std::vector<std::byte> read_encoded(std::ifstream in, const std::filesystem::path& file) {
    std::error_code status;
    const auto size = std::filesystem::file_size(file, status);
    if (!status && size > k_max_bytes)
        throw InputError(file.string() + ": larger than 2 GB; scale the image down");
    std::vector<std::byte> encoded(status ? 0 : size);
    in.read(reinterpret_cast<char*>(encoded.data()), static_cast<std::streamsize>(encoded.size()));
    if (!in) throw IoError(file.string() + ": cannot read the image file; check its permissions");
    return encoded;
}

}  // namespace

std::vector<std::byte> read_image_bytes(const std::filesystem::path& file) {
    return read_encoded(open_input(file, file.string(), "image file"), file);
}

PixelImage read_image(const std::filesystem::path& file) {
    return read_image(read_image_bytes(file), file.string());
}

PixelImage read_own_image(const std::filesystem::path& file) {
    return read_image(read_encoded(open_own_file(file), file), file.string());
}

PixelImage read_linear_image(const std::filesystem::path& file) {
    const std::vector<std::byte> encoded = read_image_bytes(file);
    const std::optional<ImageFormat> format = other_image_format(encoded, file.string());
    PixelImage image;
    if (format) image = read_other_image(encoded, *format, file.string(), ImageRange::any);
    if (!image.is_linear)
        throw InputError(
            file.string() +
            ": not an image of linear floating-point values; PNG, JPEG and other whole numbers "
            "hold "
            "nothing above white, and not in proportion to light: convert what it was made from to "
            ".exr or .hdr, or to a TIFF of floats");
    return image;
}

PixelImage read_image(std::span<const std::byte> encoded, const std::string& name) {
    if (starts_with(encoded, {0x89, 'P', 'N', 'G'})) return read_png(encoded, name);
    if (starts_with(encoded, {0xff, 0xd8, 0xff})) return read_jpeg(encoded, name);
    if (const std::optional<ImageFormat> other = other_image_format(encoded, name))
        return read_other_image(encoded, *other, name);
    throw InputError(name +
                     ": cannot read the image: none of the formats known; save it as PNG or JPEG");
}

ImageMetadata metadata_in(const ExrOptions& options, const ImageMetadata& metadata) {
    ImageMetadata result = metadata;
    if (options.is_aces) result[k_rgb_space] = std::string(k_aces);
    return result;
}

bool has_header_of(const std::filesystem::path& file, const ImageLayout& layout,
                   const ImageMetadata& image_metadata) {
    const ImageMetadata metadata = metadata_in(layout.storage, image_metadata);
    const std::optional<ExrHeader> header = read_exr_header(file);
    if (!header || header->width != layout.width || header->height != layout.height ||
        header->window != layout.window || header->compression != layout.storage.compression ||
        !is_stored_with(layout.storage.precision, header->channels))
        return false;
    std::vector<std::string> names;
    for (const ExrChannel& channel : header->channels) names.push_back(channel.name);
    if (!std::ranges::is_permutation(names, layout.channel_names)) return false;
    return std::ranges::all_of(metadata, [&](const auto& entry) {
        const auto& [name, value] = entry;
        const auto found = header->metadata.find(name);
        if (found == header->metadata.end() || found->second.index() != value.index()) return false;
        if (const auto* number = std::get_if<double>(&value))
            return std::get<double>(found->second) ==
                   static_cast<double>(static_cast<float>(*number));
        return found->second == value;
    });
}

std::optional<PreviewHeader> read_preview_header(const std::filesystem::path& file) {
    const std::optional<PngHeader> png = read_png_header(file);
    PreviewHeader header;
    if (!png || !png->texts.contains("exposure") ||
        parse_number(png->texts.at("exposure"), header.exposure) != NumberText::number)
        return std::nullopt;
    header.bits = png->bits;
    if (const auto view = png->texts.find("view"); view != png->texts.end())
        header.view = view->second;
    return header;
}

void write_exr(const std::filesystem::path& file, const Film& film, const ImageMetadata& metadata,
               const ExrOptions& options) {
    OutputFile out(file);
    write_exr(out, film, metadata, options);
    out.commit();
}

namespace {

const std::vector<std::string> k_rgba{"R", "G", "B", "A"};

Film film_in_aces(const Film& film) {
    Film aces = with_channels(film, k_rgba, film.window());
    const PixelWindow& window = film.window();
    for (int y = window.y0; y < window.y1; ++y) {
        throw_if_stopped();
        for (int x = window.x0; x < window.x1; ++x) srgb_to_aces(aces.pixel(x, y).first<3>());
    }
    return aces;
}

}  // namespace

void write_exr(OutputFile& out, const Film& film, const ImageMetadata& metadata,
               const ExrOptions& options) {
    if (options.is_aces) {
        ExrOptions as_converted = options;
        as_converted.is_aces = false;
        write_exr(out, film_in_aces(film), metadata_in(options, metadata), as_converted);
        return;
    }
    const ExrHeader header{film.width(),        film.height(),
                           film.window(),       exr_channels(film, options.precision),
                           options.compression, metadata};
    write_exr_file(out, film, header);
}

double as_stated_in_png(double value) {
    double rounded = value;
    parse_number(png_number(value), rounded);
    return rounded;
}

void write_png(const std::filesystem::path& file, const Preview& image,
               const ImageMetadata& metadata) {
    OutputFile out(file);
    write_png_file(out, image, metadata);
    out.commit();
}

void write_png(const std::filesystem::path& file, const Preview16& image,
               const ImageMetadata& metadata) {
    OutputFile out(file);
    write_png_file(out, image, metadata);
    out.commit();
}

void write_png(const std::filesystem::path& file, const DigitalImage& image,
               const ImageMetadata& metadata) {
    OutputFile out(file);
    write_png_file(out, image, metadata);
    out.commit();
}

}  // namespace uw
