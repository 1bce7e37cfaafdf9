#include "core/image/picture_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/base/error.h"
#include "core/image/image_formats.h"
#include "core/image/jpeg_file.h"
#include "core/image/png_file.h"

namespace uw {

namespace {

/// Of a JPEG that shows what a PNG would: high enough that no block is seen.
constexpr int k_jpeg_quality = 95;

std::string text_of(const ImageMetadata& metadata, const char* name) {
    const auto entry = metadata.find(name);
    if (entry == metadata.end()) return {};
    const auto* text = std::get_if<std::string>(&entry->second);
    return text ? *text : png_number(std::get<double>(entry->second));
}

/// One line about an image, for formats that have a place for no more, nor for all of a long one.
std::string description_of(const ImageMetadata& metadata) {
    std::string line;
    for (const char* name : {"exposure", "view", "uwvdb/rgb_quantity"})
        if (const std::string text = text_of(metadata, name); !text.empty())
            line += fmt::format("{}{}: {}", line.empty() ? "" : "; ", name, text);
    return line;
}

template <class Colour>
void write_encoded(OutputFile& out, const OutputFormat& format, const Grid2D<Colour>& picture,
                   const ImageMetadata& metadata, bool is_srgb) {
    using enum ImageValues::Type;
    constexpr bool k_is_8_bit = sizeof(typename Colour::value_type) == 1;
    write_other_image(
        out, format,
        {picture.width(), picture.height(), 3, k_is_8_bit ? u8 : u16, picture.values().data(),
         is_srgb, text_of(metadata, "software"), description_of(metadata)});
}

void write_jpeg(OutputFile& out, const Preview& picture, const ImageMetadata& metadata,
                bool is_srgb) {
    DigitalImage image{picture.width(), picture.height(), 3, 8, is_srgb, {}};
    image.values.reserve(3 * picture.size());
    for (const Srgb8& pixel : picture.values())
        image.values.insert(image.values.end(), pixel.begin(), pixel.end());
    write_jpeg_file(out, image, k_jpeg_quality, metadata);
}

}  // namespace

void write_picture(OutputFile& out, const Film& film, const PictureOptions& options,
                   const ImageMetadata& image_metadata) {
    const OutputFormat* const format = output_format(out.path());
    assert(format != nullptr && format->holds != OutputFormat::Holds::light);
    using enum OutputFormat::Library;
    const bool is_srgb = options.view == nullptr;
    ImageMetadata metadata = image_metadata;
    metadata["exposure"] = options.exposure;
    if (!is_srgb) metadata["view"] = options.view->name;
    if (options.bits.value_or(format->usual_bits) == 16) {
        const Preview16 picture = make_preview16(film, options.exposure, options.view);
        if (format->library == libpng)
            write_png_file(out, picture, metadata, is_srgb);
        else
            write_encoded(out, *format, picture, metadata, is_srgb);
        return;
    }
    const Preview picture = make_preview(film, options.exposure, options.view);
    if (format->library == libpng)
        write_png_file(out, picture, metadata, is_srgb);
    else if (format->library == libjpeg)
        write_jpeg(out, picture, metadata, is_srgb);
    else
        write_encoded(out, *format, picture, metadata, is_srgb);
}

void write_light(OutputFile& out, const Film& film, const ImageMetadata& metadata) {
    const OutputFormat* const format = output_format(out.path());
    assert(format != nullptr && format->library == OutputFormat::Library::openimageio);
    const bool is_signed = format->holds == OutputFormat::Holds::either;
    const std::size_t channels = is_signed ? 4 : 3;
    const PixelWindow& window = film.window();
    std::vector<float> values;
    values.reserve(channels * static_cast<std::size_t>(window.width()) *
                   static_cast<std::size_t>(window.height()));
    for (int y = window.y0; y < window.y1; ++y) {
        throw_if_stopped();
        for (int x = window.x0; x < window.x1; ++x)
            for (const float value : film.pixel(x, y).first(channels))
                values.push_back(is_signed ? value : std::max(value, 0.0F));
    }
    write_other_image(
        out, *format,
        {window.width(), window.height(), static_cast<int>(channels), ImageValues::Type::f32,
         values.data(), false, text_of(metadata, "software"), description_of(metadata)});
}

}  // namespace uw
