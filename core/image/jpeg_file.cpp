#include "core/image/jpeg_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include <jerror.h>
#include <jpeglib.h>

#include "core/base/error.h"
#include "core/image/pixel_image.h"
#include "core/image/png_file.h"

namespace uw {

// After jpeglib.h:

namespace {

/// libjpeg with an image in memory. It reports errors by a jump, which must not pass over anything
/// that has a destructor: each of these functions returns false instead.
class JpegDecoder {
  public:
    JpegDecoder() {
        jpeg_.err = jpeg_std_error(&errors_);
        jpeg_.client_data = this;
        errors_.error_exit = on_error;
        errors_.emit_message = on_message;
        jpeg_create_decompress(&jpeg_);
    }
    ~JpegDecoder() { jpeg_destroy_decompress(&jpeg_); }
    JpegDecoder(const JpegDecoder&) = delete;
    JpegDecoder& operator=(const JpegDecoder&) = delete;
    JpegDecoder(JpegDecoder&&) = delete;
    JpegDecoder& operator=(JpegDecoder&&) = delete;

    bool read_header(std::span<const std::byte> encoded) {
        if (setjmp(jump_) != 0) return false;
        jpeg_mem_src(&jpeg_, reinterpret_cast<const unsigned char*>(encoded.data()),
                     static_cast<unsigned long>(encoded.size()));
        jpeg_read_header(&jpeg_, TRUE);
        if (jpeg_.num_components == 1) jpeg_.out_color_space = JCS_GRAYSCALE;
        if (jpeg_.num_components == 3) jpeg_.out_color_space = JCS_RGB;
        if (jpeg_.num_components == 4) jpeg_.out_color_space = JCS_CMYK;
        jpeg_calc_output_dimensions(&jpeg_);
        return true;
    }
    bool read_rows(std::uint8_t* values) {
        if (setjmp(jump_) != 0) return false;
        jpeg_start_decompress(&jpeg_);
        const std::size_t row_bytes = jpeg_.output_width * static_cast<std::size_t>(channels());
        while (jpeg_.output_scanline < jpeg_.output_height) {
            throw_if_stopped();  // not from within libjpeg
            JSAMPROW row = values + jpeg_.output_scanline * row_bytes;
            jpeg_read_scanlines(&jpeg_, &row, 1);
        }
        jpeg_finish_decompress(&jpeg_);
        return true;
    }

    std::int64_t width() const { return jpeg_.output_width; }
    std::int64_t height() const { return jpeg_.output_height; }
    int channels() const { return jpeg_.output_components; }
    /// Adobe's programs store CMYK as what is left of the light.
    bool is_inverted() const { return jpeg_.saw_Adobe_marker != 0; }
    const char* error() const { return error_.data(); }

  private:
    static void on_error(j_common_ptr jpeg) {
        auto& decoder = *static_cast<JpegDecoder*>(jpeg->client_data);
        jpeg->err->format_message(jpeg, decoder.error_.data());
        std::longjmp(decoder.jump_, 1);
    }
    // The rest of a truncated image would be grey; other warnings are harmless.
    static void on_message(j_common_ptr jpeg, int) {
        if (jpeg->err->msg_code == JWRN_JPEG_EOF) on_error(jpeg);
    }

    jpeg_decompress_struct jpeg_{};
    jpeg_error_mgr errors_{};
    std::jmp_buf jump_{};
    std::array<char, JMSG_LENGTH_MAX> error_{};
};

void convert_to_rgb(PixelImage& image, bool is_inverted) {
    std::vector<float> rgb;
    rgb.reserve(image.pixels.size() / 4 * 3);
    const auto light = [&](float ink) { return is_inverted ? ink : 1 - ink; };
    for (std::size_t i = 0; i < image.pixels.size(); i += 4)
        for (std::size_t c = 0; c < 3; ++c)
            rgb.push_back(light(image.pixels[i + c]) * light(image.pixels[i + 3]));
    image.pixels = std::move(rgb);
    image.channels = 3;
}

}  // namespace

PixelImage read_jpeg(std::span<const std::byte> encoded, const std::string& name) {
    JpegDecoder decoder;
    const auto fail = [&] {
        return InputError(fmt::format("{}: cannot read the image: {}", name, decoder.error()));
    };
    if (!decoder.read_header(encoded)) throw fail();
    check_image_size(decoder.width(), decoder.height(), decoder.channels(), encoded.size(), name);
    PixelImage image{static_cast<int>(decoder.width()),
                     static_cast<int>(decoder.height()),
                     decoder.channels(),
                     {}};
    std::vector<std::uint8_t> values(static_cast<std::size_t>(image.width) *
                                     static_cast<std::size_t>(image.height) *
                                     static_cast<std::size_t>(image.channels));
    if (!decoder.read_rows(values.data())) throw fail();
    image.pixels.resize(values.size());
    std::ranges::transform(values, image.pixels.begin(),
                           [](std::uint8_t value) { return static_cast<float>(value) / 255.0F; });
    if (image.channels == 4) convert_to_rgb(image, decoder.is_inverted());
    return image;
}

namespace {

/// libjpeg with an image in memory. It reports errors by a jump, which must not pass over anything
/// that has a destructor: `encode` returns false instead.
class JpegEncoder {
  public:
    JpegEncoder() {
        jpeg_.err = jpeg_std_error(&errors_);
        jpeg_.client_data = this;
        errors_.error_exit = on_error;
        errors_.emit_message = [](j_common_ptr, int) {};
        jpeg_create_compress(&jpeg_);
    }
    ~JpegEncoder() {
        jpeg_destroy_compress(&jpeg_);
        std::free(bytes_);
    }
    JpegEncoder(const JpegEncoder&) = delete;
    JpegEncoder& operator=(const JpegEncoder&) = delete;
    JpegEncoder(JpegEncoder&&) = delete;
    JpegEncoder& operator=(JpegEncoder&&) = delete;

    /// `samples`: those of `image`.
    bool encode(const DigitalImage& image, std::uint8_t* samples, int quality,
                const std::string& comment) {
        if (setjmp(jump_) != 0) return false;
        jpeg_mem_dest(&jpeg_, &bytes_, &size_);
        jpeg_.image_width = static_cast<JDIMENSION>(image.width);
        jpeg_.image_height = static_cast<JDIMENSION>(image.height);
        jpeg_.input_components = image.channels;
        jpeg_.in_color_space = image.channels == 1 ? JCS_GRAYSCALE : JCS_RGB;
        jpeg_set_defaults(&jpeg_);
        jpeg_set_quality(&jpeg_, quality, TRUE);
        jpeg_start_compress(&jpeg_, TRUE);
        if (!comment.empty())
            jpeg_write_marker(&jpeg_, JPEG_COM, reinterpret_cast<const JOCTET*>(comment.c_str()),
                              static_cast<unsigned>(comment.size()));
        while (jpeg_.next_scanline < jpeg_.image_height) {
            throw_if_stopped();  // not from within libjpeg
            JSAMPROW row = samples + jpeg_.next_scanline * image.row_values();
            jpeg_write_scanlines(&jpeg_, &row, 1);
        }
        jpeg_finish_compress(&jpeg_);
        return true;
    }
    std::span<const std::byte> bytes() const {
        return std::as_bytes(std::span(bytes_, static_cast<std::size_t>(size_)));
    }
    const char* error() const { return error_.data(); }

  private:
    static void on_error(j_common_ptr jpeg) {
        auto& encoder = *static_cast<JpegEncoder*>(jpeg->client_data);
        jpeg->err->format_message(jpeg, encoder.error_.data());
        std::longjmp(encoder.jump_, 1);
    }

    jpeg_compress_struct jpeg_{};
    jpeg_error_mgr errors_{};
    std::jmp_buf jump_{};
    std::array<char, JMSG_LENGTH_MAX> error_{};
    unsigned char* bytes_ = nullptr;  // libjpeg allocates them
    unsigned long size_ = 0;
};

std::string comment_of(const ImageMetadata& metadata) {
    constexpr std::size_t k_longest = 65533;  // a marker's length has 16 bits and counts itself
    std::string comment;
    for (const auto& [name, value] : metadata) {
        const auto* text = std::get_if<std::string>(&value);
        const std::string line =
            fmt::format("{}: {}\n", name, text ? *text : png_number(std::get<double>(value)));
        if (comment.size() + line.size() <= k_longest) comment += line;
    }
    return comment;
}

}  // namespace

void write_jpeg_file(OutputFile& out, const DigitalImage& image, int quality,
                     const ImageMetadata& metadata) {
    constexpr int k_longest_side = JPEG_MAX_DIMENSION;
    if (std::max(image.width, image.height) > k_longest_side)
        throw IoError(
            fmt::format("{}: cannot write: a JPEG has at most {} pixels a side; write "
                        "format: png",
                        out.path().string(), k_longest_side));
    std::vector<std::uint8_t> samples(image.values.begin(), image.values.end());
    JpegEncoder encoder;
    if (!encoder.encode(image, samples.data(), quality, comment_of(metadata)))
        throw IoError(fmt::format("{}: cannot write: {}", out.path().string(), encoder.error()));
    out.write(encoder.bytes());
}

}  // namespace uw
