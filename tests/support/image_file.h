#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace uw::test {

/// An EXR, or an image in another format, as OpenImageIO reads it: every channel by its name, row
/// by row.
struct ImageFile {
    int x = 0, y = 0, width = 0, height = 0;  // of the pixels stored
    int full_width = 0, full_height = 0;
    std::vector<std::string> names;  // in the file's order
    std::map<std::string, std::vector<float>> channels;
    std::map<std::string, std::string> metadata;  // texts and numbers, as text; "format of values"

    /// Value at pixel (column, row) of the full image. Throws std::out_of_range.
    float at(const std::string& channel, int column, int row) const {
        return channels.at(channel).at(static_cast<std::size_t>((row - y) * width + (column - x)));
    }
};

/// Throws std::runtime_error if the file cannot be read.
ImageFile read_exr(const std::filesystem::path& file);

/// The bytes of an image file as OpenImageIO writes it: `extension` is that of its format; `values`
/// are of `bits` bits, row by row, channels interleaved; alpha, if any, is not premultiplied.
std::string encoded_image(const std::string& extension, int width, int height, int channels,
                          const std::vector<int>& values, int bits = 8);

}  // namespace uw::test
