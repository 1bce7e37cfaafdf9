#include "core/image_writer.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <memory>
#include <vector>

#include "core/atomic_file.h"
#include "core/error.h"

namespace uw {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file, std::string why) {
    std::ranges::replace(why, '\n', ' ');
    throw IoError(fmt::format("{}: cannot write: {}; is the disk full?", file.string(), why));
}

/// `pixels` are those of the data window, without gaps. `io` replaces the file system if given.
void encode(const std::filesystem::path& file, const std::filesystem::path& target,
            const char* format, const OIIO::ImageSpec& spec, const void* pixels,
            OIIO::Filesystem::IOProxy* io) {
    const auto output = OIIO::ImageOutput::create(format);
    if (!output) fail(file, OIIO::geterror());
    if (io != nullptr && !output->set_ioproxy(io)) fail(file, "no way to write into memory");
    const bool written =
        output->open(target.string(), spec) && output->write_image(spec.format, pixels);
    const bool closed = output->close();
    if (!written || !closed) fail(file, output->geterror());
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
    AtomicFile atomic(file);
    encode(file, atomic.temporary_path(), "openexr", spec, film.values().data(), nullptr);
    atomic.commit();
}

void write_png(const std::filesystem::path& file, const Preview& image,
               const ImageMetadata& metadata) {
    OIIO::ImageSpec spec(image.width, image.height, 3, OIIO::TypeUInt8);
    spec.attribute("oiio:ColorSpace", "sRGB");
    for (const auto& [name, value] : metadata) {
        const auto* text = std::get_if<std::string>(&value);
        spec.attribute(name, text ? *text : fmt::format("{:.6g}", std::get<double>(value)));
    }
    // The library's PNG writer does not notice when the disk is full: it writes into memory here.
    AtomicFile atomic(file);
    std::vector<unsigned char> bytes;
    OIIO::Filesystem::IOVecOutput memory(bytes);
    encode(file, file, "png", spec, image.rgb.data(), &memory);
    std::ofstream stream(atomic.temporary_path(), std::ios::binary);
    stream.write(reinterpret_cast<const char*>(bytes.data()),
                 static_cast<std::streamsize>(bytes.size()));
    stream.close();
    if (!stream) fail(file, "the file system took only a part");
    atomic.commit();
}

}  // namespace uw
