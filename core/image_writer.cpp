#include "core/image_writer.h"

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "core/atomic_file.h"
#include "core/error.h"

namespace uw {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file, std::string why) {
    std::ranges::replace(why, '\n', ' ');
    throw IoError(fmt::format("{}: cannot write: {}; is the disk full?", file.string(), why));
}

/// Writes beside `file` and renames. `pixels` are those of the data window, without gaps.
void write_whole(const std::filesystem::path& file, const char* format, const OIIO::ImageSpec& spec,
                 const void* pixels) {
    AtomicFile atomic(file);
    const auto output = OIIO::ImageOutput::create(format);
    if (!output) fail(file, OIIO::geterror());
    // Without close() its destructor would report failure a second time, to nobody.
    const bool written = output->open(atomic.temporary_path().string(), spec) &&
                         output->write_image(spec.format, pixels);
    const bool closed = output->close();
    if (!written || !closed) fail(file, output->geterror());
    atomic.commit();
}

}  // namespace

void write_exr(const std::filesystem::path& file, const Film& film, const ImageMetadata& metadata) {
    const PixelWindow& window = film.window();
    OIIO::ImageSpec spec(window.width(), window.height(),
                         static_cast<int>(film.channel_names().size()), OIIO::TypeFloat);
    spec.channelnames = film.channel_names();
    spec.alpha_channel = static_cast<int>(k_alpha);
    spec.x = window.x0;
    spec.y = window.y0;
    spec.full_width = film.width();
    spec.full_height = film.height();
    spec.attribute("compression", "zip");
    for (const auto& [name, value] : metadata) {
        if (const auto* text = std::get_if<std::string>(&value)) {
            spec.attribute(name, *text);
        } else {
            spec.attribute(name, static_cast<float>(std::get<double>(value)));
        }
    }
    write_whole(file, "openexr", spec, film.values().data());
}

void write_png(const std::filesystem::path& file, const Preview& image,
               const ImageMetadata& metadata) {
    OIIO::ImageSpec spec(image.width, image.height, 3, OIIO::TypeUInt8);
    spec.attribute("oiio:ColorSpace", "sRGB");
    for (const auto& [name, value] : metadata) {
        const auto* text = std::get_if<std::string>(&value);
        spec.attribute(name, text ? *text : fmt::format("{:.6g}", std::get<double>(value)));
    }
    write_whole(file, "png", spec, image.rgb.data());
}

}  // namespace uw
