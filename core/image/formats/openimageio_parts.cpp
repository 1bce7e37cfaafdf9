#include <OpenImageIO/imagecache.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/image/image_formats.h"

namespace {

/// What all images together keep in memory of their files.
constexpr float k_cache_mb = 128;
/// Of an image that is stored line by line, so many are kept together.
constexpr int k_lines = 64;

struct CacheEnd {
    void operator()(OIIO::ImageCache* cache) const { OIIO::ImageCache::destroy(cache); }
};

OIIO::ImageCache& cache_of_parts() {
    static const std::unique_ptr<OIIO::ImageCache, CacheEnd> cache = [] {
        std::unique_ptr<OIIO::ImageCache, CacheEnd> made(OIIO::ImageCache::create(false));
        made->attribute("max_memory_MB", k_cache_mb);
        made->attribute("autotile", k_lines);
        made->attribute("automip", 0);
        made->attribute("unassociatedalpha", 1);
        return made;
    }();
    return *cache;
}

OIIO::ImageInput* tiff_reader() {
    return OIIO::ImageInput::create("tiff", false, nullptr, nullptr, "").release();
}

OIIO::ImageInput* exr_reader() {
    return OIIO::ImageInput::create("openexr", false, nullptr, nullptr, "").release();
}

class CachedImage : public uw::PartialImage {
  public:
    CachedImage(OIIO::ImageCache::ImageHandle* file, const OIIO::ImageSpec& spec, const char* path,
                const char* reader)
        : file_(file), path_(path), reader_(reader) {
        width = spec.width;
        height = spec.height;
        channels = spec.nchannels < 3 ? (spec.alpha_channel == 1 ? 2 : 1)
                                      : (spec.alpha_channel == 3 ? 4 : 3);
        is_linear = spec.format.is_floating_point() ||
                    spec.get_string_attribute("oiio:ColorSpace") == "Linear";
    }

    bool read(int x0, int y0, int x1, int y1, float* values) const override {
        return cache_of_parts().get_pixels(file_, nullptr, 0, 0, x0, x1, y0, y1, 0, 1, 0, channels,
                                           OIIO::TypeFloat, values);
    }

    bool read_all(const Receive& receive) const override {
        const auto input = OIIO::ImageInput::create(reader_, false, nullptr, nullptr, "");
        OIIO::ImageSpec config, spec;
        config.attribute("oiio:UnassociatedAlpha", 1);
        if (!input || !input->open(path_, spec, config) || spec.width != width ||
            spec.height != height)
            return false;
        const bool is_tiled = spec.tile_width > 0;
        const int lines = is_tiled ? spec.tile_height : k_lines;
        std::vector<float> values(static_cast<std::size_t>(channels) *
                                  static_cast<std::size_t>(width) *
                                  static_cast<std::size_t>(lines));
        for (int y0 = 0; y0 < height; y0 += lines) {
            const int y1 = std::min(y0 + lines, height);
            const bool is_read = is_tiled
                                     ? input->read_tiles(0, 0, 0, width, y0, y1, 0, 1, 0, channels,
                                                         OIIO::TypeFloat, values.data())
                                     : input->read_scanlines(0, 0, y0, y1, 0, 0, channels,
                                                             OIIO::TypeFloat, values.data());
            // A TIFF that ends early is read "well".
            if (!is_read || input->has_error()) return false;
            receive(y0, y1, values.data());
        }
        return true;
    }

  private:
    OIIO::ImageCache::ImageHandle* file_;
    std::string path_, reader_;
};

}  // namespace

extern "C" uw::OpenParts uwvdb_open_parts_1;

extern "C" void uwvdb_open_parts_1(const char* path, const char* reader,
                                   std::shared_ptr<const uw::PartialImage>& image,
                                   std::string& fault) {
    OIIO::ImageCache& cache = cache_of_parts();
    const OIIO::ustring name(path);
    // By its format's reader alone, whatever its name ends in; again, since it may have changed.
    cache.invalidate(name, true);
    cache.add_file(name, std::string_view(reader) == "tiff" ? tiff_reader : exr_reader, nullptr,
                   true);
    OIIO::ImageCache::ImageHandle* const file = cache.get_image_handle(name);
    const OIIO::ImageSpec* const spec =
        file != nullptr ? cache.imagespec(file, nullptr, 0, 0, true) : nullptr;
    if (spec == nullptr) {
        const std::string all = cache.geterror();
        fault = all.substr(0, all.find('\n'));
        return;
    }
    if (spec->x != 0 || spec->y != 0 || spec->width != spec->full_width ||
        spec->height != spec->full_height || spec->depth > 1 || spec->deep) {
        fault = "not all of the image is stored, or it is deep";
        return;
    }
    image = std::make_shared<CachedImage>(file, *spec, path, reader);
}
