#include "core/image/image_formats.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/input_files.h"
#include "core/base/troubleshooting.h"
#include "core/image/exr_file.h"
#include "core/image/loaded_module.h"

namespace uw {

namespace {

constexpr std::array<std::string_view, 13> k_endings{".png", ".jpg", ".jpeg", ".tif", ".tiff",
                                                     ".exr", ".hdr", ".pic",  ".bmp", ".webp",
                                                     ".psd", ".tga", ".tx"};

constexpr const char* k_openexr = "openexr";  // its reader's name

std::string ending_of(const std::filesystem::path& file) {
    std::string ending = file.extension().string();
    std::ranges::transform(ending, ending.begin(), [](char c) {
        return c >= 'A' && c <= 'Z' ? static_cast<char>(c + ('a' - 'A')) : c;
    });
    return ending;
}

bool has_at(std::span<const std::byte> encoded, std::size_t begin, std::string_view magic) {
    return encoded.size() >= begin + magic.size() &&
           std::equal(magic.begin(), magic.end(),
                      encoded.begin() + static_cast<std::ptrdiff_t>(begin),
                      [](char a, std::byte b) {
                          return static_cast<unsigned char>(a) == std::to_integer<unsigned>(b);
                      });
}

}  // namespace

std::optional<ImageFormat> other_image_format(std::span<const std::byte> encoded,
                                              const std::string& name) {
    using namespace std::string_view_literals;
    const auto begins = [&](std::string_view magic) { return has_at(encoded, 0, magic); };
    if (begins("II*\0"sv) || begins("MM\0*"sv) || begins("II+\0"sv) || begins("MM\0+"sv))
        return ImageFormat{"TIFF", "tiff"};
    if (begins("\x76\x2f\x31\x01"sv)) return ImageFormat{"OpenEXR", k_openexr};
    if (begins("#?RADIANCE"sv) || begins("#?RGBE"sv)) return ImageFormat{"Radiance HDR", "hdr"};
    if (begins("8BPS"sv)) return ImageFormat{"PSD", "psd"};
    if (begins("RIFF"sv) && has_at(encoded, 8, "WEBP"sv)) return ImageFormat{"WebP", "webp"};
    if (begins("BM"sv)) return ImageFormat{"BMP", "bmp"};
    if (ending_of(name) == ".tga") return ImageFormat{"TGA", "targa"};
    return std::nullopt;
}

bool has_ending_of_image(const std::filesystem::path& file) {
    return std::ranges::find(k_endings, ending_of(file)) != k_endings.end();
}

namespace {

constexpr const char* k_module = "uwvdb_image_formats";
std::string how_to_install_module() {
    return how_to_install("uwvdb-image-formats");
}

PixelImage in_range(ImageRange range, PixelImage image) {
    if (range == ImageRange::any) return image;
    for (float& value : image.pixels)
        value = std::isnan(value) ? 0.0F : std::clamp(value, 0.0F, 1.0F);
    return image;
}

bool is_stopped() {
    try {
        throw_if_stopped();
    } catch (const Interrupted&) {
        return true;
    }
    return false;
}

/// Reads numbers of a PSD, which have their high byte first.
class PsdNumbers {
  public:
    explicit PsdNumbers(std::span<const std::byte> bytes) : left_(bytes) {}

    std::size_t left() const { return left_.size(); }
    std::uint64_t number(std::size_t bytes) {
        std::uint64_t value = 0;
        for (const std::byte each : take(bytes))
            value = value << 8U | std::to_integer<std::uint64_t>(each);
        return value;
    }
    /// The next bytes; all that are left, and is_short, if those are fewer.
    std::span<const std::byte> take(std::uint64_t bytes) {
        is_short |= bytes > left_.size();
        const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(bytes, left_.size()));
        const auto taken = left_.first(count);
        left_ = left_.subspan(count);
        return taken;
    }

    bool is_short = false;

  private:
    std::span<const std::byte> left_;
};

/// What is wrong with a PSD; empty if nothing is. OpenImageIO 2.4 makes room for as much as a part
/// says that it holds before it reads that, 4 GB if a file of 100 bytes says so, and looks for the
/// channels of colours that the file does not have.
std::string fault_of_psd(std::span<const std::byte> psd) {
    constexpr std::array<std::uint64_t, 10> k_channels_of_mode{1, 1, 1, 3, 4, 1, 1, 1, 1, 3};
    constexpr std::uint64_t k_large_version = 2, k_rle = 1;
    constexpr std::uint64_t k_old_thumbnail = 1033, k_thumbnail = 1036, k_thumbnail_header = 28;
    constexpr const char* k_overlong = "a part of it is longer than the file";
    PsdNumbers file(psd);
    file.take(4);
    const bool is_large = file.number(2) == k_large_version;
    file.take(6);
    const std::uint64_t channels = file.number(2), rows = file.number(4);
    file.take(4 + 2);  // columns and bits
    const std::uint64_t mode = file.number(2);
    if (mode >= k_channels_of_mode.size() || channels < k_channels_of_mode[mode])
        return "it has fewer channels than its colours need";
    file.take(file.number(4));  // the palette
    PsdNumbers resources(file.take(file.number(4)));
    file.take(file.number(is_large ? 8 : 4));  // the layers
    while (resources.left() > 0 && !resources.is_short) {
        resources.take(4);
        const std::uint64_t kind = resources.number(2);
        const std::uint64_t name = resources.number(1);
        resources.take(name + (name + 1) % 2);  // to an even number with the byte of its length
        const std::uint64_t bytes = resources.number(4);
        if ((kind == k_old_thumbnail || kind == k_thumbnail) && bytes < k_thumbnail_header)
            return "its thumbnail is shorter than a thumbnail's header";
        resources.take(bytes);
        if (bytes % 2 == 1 && resources.left() > 0) resources.take(1);
    }
    if (file.number(2) == k_rle) {
        const std::size_t size = is_large ? 4 : 2;
        PsdNumbers lengths(file.take(channels * rows * size));
        while (lengths.left() > 0)
            if (lengths.number(size) > file.left()) return k_overlong;
    }
    return file.is_short || resources.is_short ? k_overlong : "";
}

}  // namespace

PixelImage read_other_image(std::span<const std::byte> encoded, const ImageFormat& format,
                            const std::string& name, ImageRange range) {
    if (std::string_view(format.reader) == k_openexr)
        return in_range(range, read_exr(encoded, name));
    static const ModuleFunction module = load_function(k_module, k_decode_image);
    if (module.address == nullptr)
        throw InputError(fmt::format("{}: {} images need OpenImageIO ({}); {}; or save it as {}{}",
                                     name, format.name, module.fault, how_to_install_module(),
                                     range == ImageRange::any ? "OpenEXR" : "OpenEXR, PNG or JPEG",
                                     see_troubleshooting("Installing")));
    return decode_other_image(*reinterpret_cast<DecodeImage*>(module.address), encoded, format,
                              name, range);
}

PixelImage decode_other_image(DecodeImage& decode, std::span<const std::byte> encoded,
                              const ImageFormat& format, const std::string& name,
                              ImageRange range) {
    PixelImage image;
    const ImageReceiver receiver{
        [&](int width, int height, int channels, bool is_linear) {
            if (width < 1 || height < 1)
                throw InputError(name + ": the image has no pixels; the file is damaged");
            check_image_size(width, height, channels, encoded.size(), name);
            image.width = width;
            image.height = height;
            image.channels = channels;
            image.is_linear = is_linear;
            image.pixels.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
                                static_cast<std::size_t>(channels));
            return image.pixels.data();
        },
        is_stopped};
    std::string fault;
    if (std::string_view(format.reader) == "psd") fault = fault_of_psd(encoded);
    if (fault.empty()) decode(encoded, format.reader, receiver, fault);
    throw_if_stopped();
    if (!fault.empty())
        throw InputError(fmt::format("{}: cannot read the {} image: {}; save it again, or as PNG",
                                     name, format.name, fault));
    return in_range(range, std::move(image));
}

std::shared_ptr<const PartialImage> open_partial_image(const std::filesystem::path& file,
                                                       std::int64_t max_whole) {
    std::array<std::byte, 16> beginning{};
    std::ifstream in = open_input(file, file.string(), "image file");
    in.read(reinterpret_cast<char*>(beginning.data()), beginning.size());
    const auto format = other_image_format(beginning, file.string());
    if (!format || (std::string_view(format->reader) != "tiff" &&
                    std::string_view(format->reader) != k_openexr))
        return nullptr;
    static const ModuleFunction module = load_function(k_module, k_open_parts);
    if (module.address == nullptr) return nullptr;  // whoever reads the whole will say so
    std::shared_ptr<const PartialImage> image;
    std::string fault;
    reinterpret_cast<OpenParts*>(module.address)(file.c_str(), format->reader, image, fault);
    if (!image) return nullptr;  // likewise
    const std::int64_t pixels = std::int64_t{image->width} * image->height;
    if (pixels <= max_whole) return nullptr;
    std::error_code status;
    const auto bytes = static_cast<std::int64_t>(std::filesystem::file_size(file, status));
    constexpr std::int64_t k_max_pixels = std::int64_t{1} << 33;
    constexpr std::int64_t k_max_values_per_byte = 4096;  // as in check_image_size
    if (status || pixels > k_max_pixels || pixels * image->channels / k_max_values_per_byte > bytes)
        throw InputError(
            fmt::format("{}: {} x {} pixels are more than the file holds, or than the "
                        "2^33 supported; scale the image down",
                        file.string(), image->width, image->height));
    return image;
}

namespace {

using Holds = OutputFormat::Holds;
using Library = OutputFormat::Library;
constexpr std::array<OutputFormat, 9> k_output_formats{{
    {"OpenEXR", {".exr"}, Holds::light, Library::openexr},
    {"PNG", {".png"}, Holds::pictures, Library::libpng, nullptr, 8, 16},
    {"JPEG", {".jpg", ".jpeg"}, Holds::pictures, Library::libjpeg},
    {"TIFF", {".tif", ".tiff"}, Holds::either, Library::openimageio, "tiff", 16, 16},
    {"Radiance HDR", {".hdr"}, Holds::light, Library::openimageio, "hdr"},
    {"DPX", {".dpx"}, Holds::pictures, Library::openimageio, "dpx", 16, 16},
    {"TGA", {".tga"}, Holds::pictures, Library::openimageio, "targa"},
    {"BMP", {".bmp"}, Holds::pictures, Library::openimageio, "bmp"},
    {"WebP", {".webp"}, Holds::pictures, Library::openimageio, "webp"},
}};

const ModuleFunction& encoder() {
    static const ModuleFunction module = load_function(k_module, k_encode_image);
    return module;
}

/// A file without a name, in memory: OpenImageIO seeks and reads what it has written, and is to
/// leave nothing behind.
class MemoryFile {
  public:
    MemoryFile() : descriptor_(memfd_create("image", MFD_CLOEXEC)) {
        if (descriptor_ < 0) throw IoError("cannot make a file in memory for an image");
    }
    ~MemoryFile() { ::close(descriptor_); }
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;
    MemoryFile(MemoryFile&&) = delete;
    MemoryFile& operator=(MemoryFile&&) = delete;

    std::string path() const { return fmt::format("/proc/self/fd/{}", descriptor_); }
    /// Hands over all that was written, piece by piece.
    void copy_to(OutputFile& out) const {
        std::vector<std::byte> piece(std::size_t{1} << 20);
        off_t at = 0;
        for (;;) {
            throw_if_stopped();
            const ssize_t count = ::pread(descriptor_, piece.data(), piece.size(), at);
            if (count < 0) throw IoError(out.path().string() + ": cannot read it back");
            if (count == 0) return;
            out.write(std::span(piece).first(static_cast<std::size_t>(count)));
            at += count;
        }
    }

  private:
    int descriptor_;
};

}  // namespace

const OutputFormat* output_format(const std::filesystem::path& file) {
    const std::string ending = ending_of(file);
    if (ending.empty()) return nullptr;
    for (const OutputFormat& format : k_output_formats)
        if (std::ranges::find(format.endings, ending) != format.endings.end()) return &format;
    return nullptr;
}

std::string output_endings() {
    std::string endings;
    for (const OutputFormat& format : k_output_formats)
        endings += fmt::format("{}{}", endings.empty() ? "" : ", ", format.endings.front());
    return endings;
}

void require_writer(const OutputFormat& format) {
    if (format.library != Library::openimageio || encoder().address != nullptr) return;
    throw UsageError(fmt::format(
        "{} files need OpenImageIO ({}); {}; or give a name that ends in .exr, .png or "
        ".jpg{}",
        format.name, encoder().fault, how_to_install_module(), see_troubleshooting("Installing")));
}

void write_other_image(OutputFile& out, const OutputFormat& format, const ImageValues& image) {
    require_writer(format);
    const MemoryFile file;
    std::string fault;
    reinterpret_cast<EncodeImage*>(encoder().address)(image, format.writer, file.path().c_str(),
                                                      is_stopped, fault);
    throw_if_stopped();
    if (!fault.empty())
        throw IoError(fmt::format("{}: cannot write the {} file: {}", out.path().string(),
                                  format.name, fault));
    file.copy_to(out);
}

}  // namespace uw
