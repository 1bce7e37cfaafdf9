#include "core/image/image_writer.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <fstream>

#include "core/base/atomic_file.h"
#include "core/base/error.h"

namespace uw {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file, std::string why) {
    std::ranges::replace(why, '\n', ' ');
    throw IoError(fmt::format("{}: cannot write: {}; is the disk full?", file.string(), why));
}

/// A file that records whether all of it could be written. The library's own reports success when
/// the disk is full: always for PNG, and for the last bytes written to an EXR.
class CheckedFile final : public OIIO::Filesystem::IOProxy {
  public:
    explicit CheckedFile(const std::filesystem::path& path)
        : IOProxy(path.string(), Write), stream_(path, std::ios::binary) {}

    const char* proxytype() const override { return "uwvdb"; }
    std::int64_t tell() override { return stream_.tellp(); }
    bool seek(std::int64_t offset) override { return bool(stream_.seekp(offset)); }
    std::size_t write(const void* bytes, std::size_t size) override {
        const auto count = static_cast<std::streamsize>(size);
        return stream_.write(static_cast<const char*>(bytes), count) ? size : 0;
    }
    /// Closes the file; true if it is complete.
    bool finish() {
        stream_.close();
        return stream_.good();
    }

  private:
    std::ofstream stream_;
};

/// `pixels` are those of the data window, without gaps.
void write_whole(const std::filesystem::path& file, const char* format, const OIIO::ImageSpec& spec,
                 const void* pixels) {
    AtomicFile atomic(file);
    CheckedFile checked(atomic.temporary_path());
    const auto output = OIIO::ImageOutput::create(format);
    if (!output) fail(file, OIIO::geterror());
    const bool written = output->set_ioproxy(&checked) &&
                         output->open(atomic.temporary_path().string(), spec) &&
                         output->write_image(spec.format, pixels);
    const bool closed = output->close();
    const std::string error = output->geterror();
    const bool whole = checked.finish();
    if (!written || !closed) fail(file, error);
    if (!whole) fail(file, "some of the data was rejected");
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
    spec.attribute("DateTime", "");  // no timestamp: the same scene gives the same bytes
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
    OIIO::ImageSpec spec(image.width(), image.height(), 3, OIIO::TypeUInt8);
    spec.attribute("oiio:ColorSpace", "sRGB");
    for (const auto& [name, value] : metadata) {
        const auto* text = std::get_if<std::string>(&value);
        spec.attribute(name, text ? *text : fmt::format("{:.6g}", std::get<double>(value)));
    }
    write_whole(file, "png", spec, image.values().data());
}

}  // namespace uw
