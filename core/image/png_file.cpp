#include "core/image/png_file.h"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <new>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/base/input_files.h"
#include "core/image/pixel_image.h"

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
    std::ifstream in = open_own_file(file);
    in.read(reinterpret_cast<char*>(beginning.data()), k_beginning);
    beginning.resize(static_cast<std::size_t>(in.gcount()));
    PngDecoder decoder(beginning);
    if (!decoder.read_header()) return std::nullopt;
    PngHeader header{decoder.is_16_bit() ? 16 : 8, {}};
    for (const png_text& text : decoder.texts()) header.texts[text.key] = text.text;
    return header;
}

namespace {

/// What a PNG's rows hold.
struct PngLayout {
    int width, height;
    int channels;  // 1 or 3
    int bits;      // 8 or 16
    bool is_srgb;
};

/// libpng with a file. It reports errors by a jump, which must not pass over anything that has a
/// destructor: `write` returns false instead.
class PngEncoder {
  public:
    explicit PngEncoder(OutputFile& out)
        : out_(out),
          png_(png_create_write_struct(PNG_LIBPNG_VER_STRING, this, on_error, on_warning)),
          info_(png_ != nullptr ? png_create_info_struct(png_) : nullptr) {
        if (info_ == nullptr) {
            png_destroy_write_struct(&png_, nullptr);
            throw std::bad_alloc();
        }
        png_set_write_fn(png_, this, on_write, on_flush);
    }
    ~PngEncoder() { png_destroy_write_struct(&png_, &info_); }
    PngEncoder(const PngEncoder&) = delete;
    PngEncoder& operator=(const PngEncoder&) = delete;
    PngEncoder(PngEncoder&&) = delete;
    PngEncoder& operator=(PngEncoder&&) = delete;

    /// `row(y)`: where its values begin.
    template <class Row>
    bool write(const PngLayout& layout, const Row& row, std::span<const png_text> texts) {
        if (setjmp(png_jmpbuf(png_)) != 0) return false;
        png_set_IHDR(png_, info_, static_cast<png_uint_32>(layout.width),
                     static_cast<png_uint_32>(layout.height), layout.bits,
                     layout.channels == 1 ? PNG_COLOR_TYPE_GRAY : PNG_COLOR_TYPE_RGB,
                     PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_BASE, PNG_FILTER_TYPE_BASE);
        if (layout.is_srgb) png_set_sRGB(png_, info_, PNG_sRGB_INTENT_PERCEPTUAL);
        png_set_text(png_, info_, texts.data(), static_cast<int>(texts.size()));
        // More effort saves a tenth at several times the cost.
        png_set_compression_level(png_, 1);
        png_set_filter(png_, PNG_FILTER_TYPE_BASE, PNG_FILTER_UP);
        png_write_info(png_, info_);
        if (layout.bits == 16) png_set_swap(png_);  // stored with the higher byte first
        for (int y = 0; y < layout.height; ++y) {
            throw_if_stopped();  // not from within libpng
            png_write_row(png_, reinterpret_cast<png_const_bytep>(row(y)));
        }
        png_write_end(png_, nullptr);
        return true;
    }
    const char* error() const { return error_; }

  private:
    static void on_error(png_structp png, png_const_charp message) {
        auto& encoder = *static_cast<PngEncoder*>(png_get_error_ptr(png));
        std::strncpy(encoder.error_, message, sizeof(encoder.error_) - 1);
        png_longjmp(png, 1);
    }
    static void on_warning(png_structp, png_const_charp) {}
    static void on_write(png_structp png, png_bytep bytes, std::size_t count) {
        static_cast<PngEncoder*>(png_get_io_ptr(png))
            ->out_.write(std::as_bytes(std::span(bytes, count)));
    }
    static void on_flush(png_structp) {}

    OutputFile& out_;
    char error_[128] = {};
    png_structp png_;
    png_infop info_;
};

/// `keyword` and `text` outlive it.
png_text text_chunk(const std::string& keyword, const std::string& text) {
    // The plain kind is Latin-1.
    const bool is_ascii = std::ranges::all_of(text, [](char c) { return c >= 0; });
    png_text chunk{};
    chunk.compression = is_ascii ? PNG_TEXT_COMPRESSION_NONE : PNG_ITXT_COMPRESSION_NONE;
    chunk.key = const_cast<char*>(keyword.c_str());  // libpng copies both
    chunk.text = const_cast<char*>(text.c_str());
    chunk.text_length = text.size();
    return chunk;
}

template <class Row>
void write_file(OutputFile& out, const PngLayout& layout, const Row& row,
                const ImageMetadata& metadata) {
    std::vector<std::string> values;
    values.reserve(metadata.size());
    std::vector<png_text> texts;
    for (const auto& [name, value] : metadata) {
        const auto* text = std::get_if<std::string>(&value);
        values.push_back(text ? *text : png_number(std::get<double>(value)));
        texts.push_back(text_chunk(name, values.back()));
    }
    PngEncoder encoder(out);
    if (!encoder.write(layout, row, texts))
        throw IoError(fmt::format("{}: cannot write: {}", out.path().string(), encoder.error()));
}

template <class Colour>
void write_preview(OutputFile& out, const Grid2D<Colour>& image, const ImageMetadata& metadata,
                   bool is_srgb) {
    static_assert(sizeof(Colour) == 3 * sizeof(typename Colour::value_type));
    constexpr int k_bits = 8 * sizeof(typename Colour::value_type);
    write_file(
        out, {image.width(), image.height(), 3, k_bits, is_srgb},
        [&](int y) { return image.row(y).front().data(); }, metadata);
}

}  // namespace

std::string png_number(double value) {
    return fmt::format("{:.6g}", value);
}

void write_png_file(OutputFile& out, const Preview& image, const ImageMetadata& metadata,
                    bool is_srgb) {
    write_preview(out, image, metadata, is_srgb);
}

void write_png_file(OutputFile& out, const Preview16& image, const ImageMetadata& metadata,
                    bool is_srgb) {
    write_preview(out, image, metadata, is_srgb);
}

void write_png_file(OutputFile& out, const DigitalImage& image, const ImageMetadata& metadata) {
    const PngLayout layout{image.width, image.height, image.channels, image.bits, image.is_srgb};
    const auto first_of = [&](int y) { return static_cast<std::size_t>(y) * image.row_values(); };
    if (image.bits == 16) {
        write_file(
            out, layout, [&](int y) { return &image.values[first_of(y)]; }, metadata);
        return;
    }
    const std::vector<std::uint8_t> bytes(image.values.begin(), image.values.end());
    write_file(
        out, layout, [&](int y) { return &bytes[first_of(y)]; }, metadata);
}

}  // namespace uw
