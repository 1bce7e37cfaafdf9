#include "core/image/png_reader.h"

#include <fmt/format.h>
#include <png.h>

#include <csetjmp>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <new>
#include <vector>

#include "core/base/error.h"
#include "core/base/stop.h"
#include "core/image/image_limits.h"

namespace uw {
namespace {

/// libpng with an image in memory. It reports errors by a jump, which must not pass over anything
/// that has a destructor: each of these functions returns false instead.
class PngDecoder {
  public:
    explicit PngDecoder(std::span<const std::byte> encoded)
        : left_(encoded),
          png_(png_create_read_struct(PNG_LIBPNG_VER_STRING, this, on_error, on_warning)),
          info_(png_ != nullptr ? png_create_info_struct(png_) : nullptr) {
        if (info_ == nullptr) {
            png_destroy_read_struct(&png_, nullptr, nullptr);
            throw std::bad_alloc();
        }
        png_set_read_fn(png_, this, on_read);
    }
    ~PngDecoder() { png_destroy_read_struct(&png_, &info_, nullptr); }
    PngDecoder(const PngDecoder&) = delete;
    PngDecoder& operator=(const PngDecoder&) = delete;
    PngDecoder(PngDecoder&&) = delete;
    PngDecoder& operator=(PngDecoder&&) = delete;

    bool read_header() {
        if (setjmp(png_jmpbuf(png_)) != 0) return false;
        png_read_info(png_, info_);
        png_set_expand(png_);
        png_set_swap(png_);  // 16 bits are stored with the higher byte first
        passes_ = png_set_interlace_handling(png_);
        png_read_update_info(png_, info_);
        return true;
    }
    bool read_rows(png_bytepp rows) {
        if (setjmp(png_jmpbuf(png_)) != 0) return false;
        const std::int64_t count = height();
        for (int pass = 0; pass < passes_; ++pass)
            for (std::int64_t y = 0; y < count; ++y) {
                throw_if_stopped();  // not from within libpng
                png_read_row(png_, rows[y], nullptr);
            }
        png_read_end(png_, nullptr);
        return true;
    }

    std::int64_t width() const { return png_get_image_width(png_, info_); }
    std::int64_t height() const { return png_get_image_height(png_, info_); }
    int channels() const { return png_get_channels(png_, info_); }
    bool is_16_bit() const { return png_get_bit_depth(png_, info_) == 16; }
    std::size_t row_bytes() const { return png_get_rowbytes(png_, info_); }
    const char* error() const { return error_; }
    std::span<const png_text> texts() {
        png_textp texts = nullptr;
        int count = 0;
        png_get_text(png_, info_, &texts, &count);
        return {texts, static_cast<std::size_t>(count)};
    }

  private:
    static PngDecoder& decoder_of(png_structp png) {
        return *static_cast<PngDecoder*>(png_get_error_ptr(png));
    }
    static void on_error(png_structp png, png_const_charp message) {
        PngDecoder& decoder = decoder_of(png);
        std::strncpy(decoder.error_, message, sizeof(decoder.error_) - 1);
        png_longjmp(png, 1);
    }
    static void on_warning(png_structp, png_const_charp) {}
    static void on_read(png_structp png, png_bytep out, std::size_t count) {
        PngDecoder& decoder = decoder_of(png);
        if (count > decoder.left_.size()) png_error(png, "the file is truncated");
        std::memcpy(out, decoder.left_.data(), count);
        decoder.left_ = decoder.left_.subspan(count);
    }

    std::span<const std::byte> left_;
    char error_[128] = {};
    png_structp png_;
    png_infop info_;
    int passes_ = 1;  // of an interlaced image
};

}  // namespace

PixelImage read_png(std::span<const std::byte> encoded, const std::string& name) {
    PngDecoder decoder(encoded);
    const auto fail = [&] {
        return InputError(fmt::format("{}: cannot read the image: {}", name, decoder.error()));
    };
    if (!decoder.read_header()) throw fail();
    check_image_size(decoder.width(), decoder.height(), decoder.channels(), encoded.size(), name);
    PixelImage image{static_cast<int>(decoder.width()),
                     static_cast<int>(decoder.height()),
                     decoder.channels(),
                     {}};
    const auto height = static_cast<std::size_t>(image.height);
    std::vector<std::uint8_t> values(height * decoder.row_bytes());
    std::vector<png_bytep> rows(height);
    for (std::size_t y = 0; y < height; ++y) rows[y] = values.data() + y * decoder.row_bytes();
    if (!decoder.read_rows(rows.data())) throw fail();

    image.pixels.resize(values.size() / (decoder.is_16_bit() ? 2 : 1));
    const std::size_t row_values = image.pixels.size() / height;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        if (i % row_values == 0) throw_if_stopped();
        if (decoder.is_16_bit()) {
            std::uint16_t value = 0;
            std::memcpy(&value, values.data() + 2 * i, 2);
            image.pixels[i] = static_cast<float>(value) / 65535.0F;
        } else {
            image.pixels[i] = static_cast<float>(values[i]) / 255.0F;
        }
    }
    return image;
}

std::optional<PngHeader> read_png_header(const std::filesystem::path& file) {
    // Far more than the texts of an image take.
    constexpr std::size_t k_beginning = std::size_t{1} << 18;
    std::vector<std::byte> beginning(k_beginning);
    std::ifstream in(file, std::ios::binary);
    in.read(reinterpret_cast<char*>(beginning.data()), k_beginning);
    beginning.resize(static_cast<std::size_t>(in.gcount()));
    PngDecoder decoder(beginning);
    if (!decoder.read_header()) return std::nullopt;
    PngHeader header{decoder.is_16_bit() ? 16 : 8, {}};
    for (const png_text& text : decoder.texts()) header.texts[text.key] = text.text;
    return header;
}

}  // namespace uw
