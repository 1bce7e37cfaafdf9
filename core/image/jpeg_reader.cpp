#include "core/image/jpeg_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstdint>
#include <cstdio>  // jpeglib.h needs it
#include <vector>

#include <jpeglib.h>
// After jpeglib.h:
#include <jerror.h>

#include "core/base/error.h"
#include "core/base/stop.h"
#include "core/image/image_limits.h"

namespace uw {
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

}  // namespace uw
