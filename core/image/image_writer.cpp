#include "core/image/image_writer.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/parallel.h"
#include "core/image/exr_blocks.h"
#include "core/image/exr_header.h"
#include "core/image/output_file.h"
#include "core/image/png_file.h"

namespace uw {

namespace {

// Held in memory before they are written.
constexpr std::size_t k_blocks_at_once = 64;

}  // namespace

void write_exr(const std::filesystem::path& file, const Film& film, const ImageMetadata& metadata,
               const ExrOptions& options) {
    const ExrHeader header{film.width(),        film.height(),
                           film.window(),       exr_channels(film, options.precision),
                           options.compression, metadata};
    const ExrBlocks blocks(film, header);
    OutputFile out(file);
    out.write(encoded(header));
    const std::uint64_t table = out.size();
    std::vector<std::uint64_t> offsets(blocks.count());
    out.write(std::as_bytes(std::span(offsets)));  // to be filled in
    for (std::size_t begin = 0; begin < offsets.size(); begin += k_blocks_at_once) {
        std::vector<std::vector<std::byte>> some(
            std::min(k_blocks_at_once, offsets.size() - begin));
        parallel_for(some.size(), [&](std::size_t i) { some[i] = blocks.encoded(begin + i); });
        for (std::size_t i = 0; i < some.size(); ++i) {
            offsets[begin + i] = out.size();
            out.write(some[i]);
        }
    }
    out.rewrite(table, std::as_bytes(std::span(offsets)));
    out.commit();
}

void write_png(const std::filesystem::path& file, const Preview& image,
               const ImageMetadata& metadata) {
    OutputFile out(file);
    out.write(encoded_png(image, metadata));
    out.commit();
}

}  // namespace uw
