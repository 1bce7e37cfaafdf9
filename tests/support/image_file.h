#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace uw::test {

/// An EXR, or an image in another format, as OpenImageIO reads it: every channel by its name, row
/// by row.
struct ImageFile {
    int x = 0, y = 0, width = 0, height = 0;  // of the pixels stored
    int full_x = 0, full_y = 0, full_width = 0, full_height = 0;
    int images = 1;  // in the file
    bool is_tiled = false;
    std::vector<std::string> names;  // in the file's order
    std::map<std::string, std::vector<float>> channels;
    std::map<std::string, std::string> formats;   // of channels, as stored: "uint8", "half" …
    std::map<std::string, std::string> metadata;  // texts and numbers, as text

    /// Value at pixel (column, row) of the full image. Throws std::out_of_range.
    float at(const std::string& channel, int column, int row) const {
        return channels.at(channel).at(static_cast<std::size_t>((row - y) * width + (column - x)));
    }
};

/// Whole numbers are fractions of their format's largest. Throws std::runtime_error if the file
/// cannot be read.
ImageFile read_exr(const std::filesystem::path& file);

/// The numbers of an image of so many bits, row by row, channels interleaved.
std::vector<std::uint16_t> numbers_of(const ImageFile& image, int bits);

/// The bytes of an image file as OpenImageIO writes it: `extension` is that of its format; `values`
/// are of `bits` bits, row by row, channels interleaved; alpha, if any, is not premultiplied.
std::string encoded_image(const std::string& extension, int width, int height, int channels,
                          const std::vector<int>& values, int bits = 8);

/// The functions of the module that does both, in which they are `uwvdb_test_read_image` and
/// `uwvdb_test_write_image`.
using ReadImageFunction = void(const std::filesystem::path& file, ImageFile& image);
using WriteImageFunction = void(const std::filesystem::path& file, int width, int height,
                                int channels, const std::vector<int>& values, int bits);

}  // namespace uw::test
