#include "core/image/deep_exr_file.h"

#include <OpenEXR/Iex.h>
#include <OpenEXR/ImfDeepFrameBuffer.h>
#include <OpenEXR/ImfDeepScanLineOutputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <vector>

#include "core/base/error.h"
#include "core/image/exr_stream.h"

namespace uw {

namespace {

/// The channels, in the alphabetical order of files, and where a sample has their values.
struct DeepChannel {
    const char* name;
    std::size_t offset;  // [bytes]
};
constexpr std::size_t k_colour_offset = offsetof(DeepSample, colour);
constexpr std::array<DeepChannel, 6> k_deep_channels{{{"A", offsetof(DeepSample, alpha)},
                                                      {"B", k_colour_offset + 2 * sizeof(float)},
                                                      {"G", k_colour_offset + sizeof(float)},
                                                      {"R", k_colour_offset},
                                                      {"Z", offsetof(DeepSample, z)},
                                                      {"ZBack", offsetof(DeepSample, z_back)}}};

/// The addresses of the values of one line's pixels, as OpenEXR takes them.
class DeepLine {
  public:
    explicit DeepLine(const PixelWindow& window)
        : window_(window), counts_(static_cast<std::size_t>(window.width())) {
        for (std::vector<const char*>& of_channel : addresses_) of_channel.resize(counts_.size());
    }

    Imf::DeepFrameBuffer at(const DeepImage& image, int y) {
        for (std::size_t i = 0; i < counts_.size(); ++i) {
            const std::vector<DeepSample>& samples =
                image.pixel(window_.x0 + static_cast<int>(i), y);
            counts_[i] = static_cast<unsigned>(samples.size());
            const char* const first = reinterpret_cast<const char*>(samples.data());
            for (std::size_t c = 0; c < k_deep_channels.size(); ++c)
                addresses_[c][i] = samples.empty() ? nullptr : first + k_deep_channels[c].offset;
        }
        Imf::DeepFrameBuffer buffer;
        // OpenEXR adds x times the stride: all lines share the storage, so that theirs is 0.
        constexpr std::size_t k_same_line = 0;
        buffer.insertSampleCountSlice(
            Imf::Slice(Imf::UINT, from_first(counts_.data()), sizeof(unsigned), k_same_line));
        for (std::size_t c = 0; c < k_deep_channels.size(); ++c)
            buffer.insert(k_deep_channels[c].name,
                          Imf::DeepSlice(Imf::FLOAT, from_first(addresses_[c].data()),
                                         sizeof(const char*), k_same_line, sizeof(DeepSample)));
        return buffer;
    }

  private:
    // The address at which column 0 would be; OpenEXR only reads.
    template <class T>
    char* from_first(const T* values) const {
        return const_cast<char*>(reinterpret_cast<const char*>(values)) -
               static_cast<std::ptrdiff_t>(sizeof(T)) * window_.x0;
    }

    PixelWindow window_;
    std::vector<unsigned> counts_;
    std::array<std::vector<const char*>, k_deep_channels.size()> addresses_;
};

}  // namespace

void write_deep_exr_file(OutputFile& out, const DeepImage& image, const PixelWindow& window,
                         const ImageMetadata& metadata, ExrCompression compression) {
    permit_exr_threads();
    ExrHeader ours{image.width(), image.height(), window, {}, compression, metadata};
    if (compression != ExrCompression::none) ours.compression = ExrCompression::zips;
    for (const DeepChannel& channel : k_deep_channels) ours.channels.push_back({channel.name});
    ExrStream stream(out);
    try {
        Imf::Header header = openexr_header(ours);
        header.setType(Imf::DEEPSCANLINE);
        Imf::DeepScanLineOutputFile file(stream, header);
        DeepLine line(window);
        for (int y = window.y0; y < window.y1; ++y) {
            throw_if_stopped();
            file.setFrameBuffer(line.at(image, y));
            file.writePixels(1);
        }
    } catch (const Iex::BaseExc& error) {
        throw IoError(fmt::format("{}: cannot write: {}", out.path().string(), error.what()));
    }
}

}  // namespace uw
