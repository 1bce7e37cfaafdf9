#include "core/image/jpeg_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstdio>  // jpeglib.h needs it
#include <cstdlib>
#include <string>

#include <jpeglib.h>

#include "core/base/error.h"
#include "core/base/stop.h"
#include "core/image/png_writer.h"

namespace uw {
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
