#include "core/image/deflate.h"

#include <zlib.h>

#include <algorithm>
#include <limits>
#include <new>
#include <stdexcept>

#include "core/base/parallel.h"

namespace uw {
namespace {

// Window bits as zlib takes them: the largest window, with a header or without.
constexpr int k_zlib_format = 15, k_raw_format = -15;
constexpr int k_memory_level = 9;
// More effort than the least, at no measurable cost.
constexpr int k_level = 2;

const Bytef* input_of(std::span<const std::byte> bytes) {
    return reinterpret_cast<const Bytef*>(bytes.data());
}

uInt size_of(std::size_t bytes) {
    if (bytes > std::numeric_limits<uInt>::max()) throw std::length_error("deflate");
    return static_cast<uInt>(bytes);
}

/// One compression, from all of its input to all of its output.
class Deflation {
  public:
    Deflation(int format, int strategy) {
        if (deflateInit2(&stream_, k_level, Z_DEFLATED, format, k_memory_level, strategy) != Z_OK)
            throw std::bad_alloc();
    }
    ~Deflation() { deflateEnd(&stream_); }
    Deflation(const Deflation&) = delete;
    Deflation& operator=(const Deflation&) = delete;
    Deflation(Deflation&&) = delete;
    Deflation& operator=(Deflation&&) = delete;

    /// `flush`: Z_FINISH at the end of the stream, Z_FULL_FLUSH where another may be appended.
    std::vector<std::byte> operator()(std::span<const std::byte> bytes, int flush) {
        constexpr std::size_t k_flush_bytes = 16;
        std::vector<std::byte> output(deflateBound(&stream_, bytes.size()) + k_flush_bytes);
        stream_.next_in = const_cast<Bytef*>(input_of(bytes));  // zlib only reads it
        stream_.avail_in = size_of(bytes.size());
        stream_.next_out = reinterpret_cast<Bytef*>(output.data());
        stream_.avail_out = size_of(output.size());
        const int done = deflate(&stream_, flush);
        if (done != (flush == Z_FINISH ? Z_STREAM_END : Z_OK) || stream_.avail_in != 0)
            throw std::logic_error("deflate: the bound was too small");
        output.resize(stream_.total_out);
        return output;
    }

  private:
    z_stream stream_{};
};

struct Part {
    std::vector<std::byte> stream;
    uLong checksum = 0;
    std::size_t bytes = 0;
};

}  // namespace

std::vector<std::byte> zlib_stream(std::span<const std::byte> bytes) {
    return Deflation(k_zlib_format, Z_DEFAULT_STRATEGY)(bytes, Z_FINISH);
}

std::vector<std::byte> zlib_stream_in_parts(std::span<const std::byte> bytes,
                                            std::size_t part_bytes) {
    std::vector<Part> parts(std::max<std::size_t>(1, (bytes.size() + part_bytes - 1) / part_bytes));
    parallel_for(parts.size(), [&](std::size_t i) {
        const std::size_t begin = i * part_bytes;
        const auto part = bytes.subspan(begin, std::min(part_bytes, bytes.size() - begin));
        const bool is_last = i + 1 == parts.size();
        parts[i].stream = Deflation(k_raw_format, Z_RLE)(part, is_last ? Z_FINISH : Z_FULL_FLUSH);
        parts[i].checksum = adler32(adler32(0, nullptr, 0), input_of(part), size_of(part.size()));
        parts[i].bytes = part.size();
    });
    // Deflate with a window of 32 KiB; the second byte makes both a multiple of 31.
    std::vector<std::byte> stream{std::byte{0x78}, std::byte{0x01}};
    uLong checksum = adler32(0, nullptr, 0);
    for (const Part& part : parts) {
        stream.insert(stream.end(), part.stream.begin(), part.stream.end());
        checksum = adler32_combine(checksum, part.checksum, static_cast<z_off_t>(part.bytes));
    }
    for (const int shift : {24, 16, 8, 0})
        stream.push_back(static_cast<std::byte>(checksum >> shift & 0xff));
    return stream;
}

std::uint32_t crc32_of(std::span<const std::byte> bytes, std::uint32_t before) {
    return static_cast<std::uint32_t>(crc32(before, input_of(bytes), size_of(bytes.size())));
}

}  // namespace uw
