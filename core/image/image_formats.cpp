#include "core/image/image_formats.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <link.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <system_error>

#include "core/base/error.h"

namespace uw {

namespace {

constexpr std::array<std::string_view, 13> k_endings{".png", ".jpg", ".jpeg", ".tif", ".tiff",
                                                     ".exr", ".hdr", ".pic",  ".bmp", ".webp",
                                                     ".psd", ".tga", ".tx"};

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
    if (begins("\x76\x2f\x31\x01"sv)) return ImageFormat{"OpenEXR", "openexr"};
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

/// The module's function, or why there is none.
struct LoadedModule {
    DecodeImage* decode = nullptr;
    std::string fault;
};

// lib/uwvdb in the nearest folder above the program or library that this code is in: of an
// installation, a build folder or a Python environment.
LoadedModule load_module() {
    Dl_info self{};
    link_map* loaded = nullptr;
    if (dladdr1(reinterpret_cast<const void*>(&has_ending_of_image), &self,
                reinterpret_cast<void**>(&loaded), RTLD_DL_LINKMAP) == 0)
        return {nullptr, "this program does not know its own place"};
    std::error_code ignored;
    // Only libraries have a file name here: what dladdr has for a program is the word that it was
    // called by, which leads nowhere if it was found along PATH.
    const bool is_library = loaded->l_name[0] != '\0';
    std::filesystem::path above =
        std::filesystem::canonical(is_library ? loaded->l_name : "/proc/self/exe", ignored);
    constexpr int k_most_above = 5;
    for (int i = 0; i < k_most_above && above.has_relative_path(); ++i) {
        above = above.parent_path();
        const std::filesystem::path file = above / UWVDB_MODULE_FOLDER / "uwvdb_image_formats.so";
        if (!std::filesystem::exists(file, ignored)) continue;
        void* const module = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
        void* const decode = module != nullptr ? dlsym(module, k_decode_image) : nullptr;
        if (decode == nullptr) return {nullptr, dlerror()};
        return {reinterpret_cast<DecodeImage*>(decode), ""};
    }
    return {nullptr, "the module uwvdb_image_formats is not installed"};
}

}  // namespace

PixelImage read_other_image(std::span<const std::byte> encoded, const ImageFormat& format,
                            const std::string& name) {
    static const LoadedModule module = load_module();
    if (module.decode == nullptr)
        throw InputError(fmt::format(
            "{}: a {} image needs OpenImageIO ({}); install the package uwvdb-image-formats, or "
            "save it as PNG or JPEG",
            name, format.name, module.fault));
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
        [] {
            try {
                throw_if_stopped();
            } catch (const Interrupted&) {
                return true;
            }
            return false;
        }};
    std::string fault;
    module.decode(encoded, format.reader, receiver, fault);
    throw_if_stopped();
    if (!fault.empty())
        throw InputError(fmt::format("{}: cannot read the {} image: {}; save it again, or as PNG",
                                     name, format.name, fault));
    for (float& value : image.pixels)
        value = std::isnan(value) ? 0.0F : std::clamp(value, 0.0F, 1.0F);
    return image;
}

}  // namespace uw
