// What tests/support/image_file.h asks of OpenImageIO. It is loaded by the tests that ask, since it
// and the 200 libraries that it needs take longer to load than most tests take.

#include <OpenImageIO/imageio.h>

#include <cstdint>
#include <stdexcept>

#include "tests/support/image_file.h"

namespace fs = std::filesystem;

extern "C" {

uw::test::ReadImageFunction uwvdb_test_read_image;
uw::test::WriteImageFunction uwvdb_test_write_image;

void uwvdb_test_read_image(const fs::path& file, uw::test::ImageFile& image) {
    const auto input = OIIO::ImageInput::open(file.string());
    if (!input) throw std::runtime_error(OIIO::geterror());
    const OIIO::ImageSpec& spec = input->spec();
    image.x = spec.x;
    image.y = spec.y;
    image.width = spec.width;
    image.height = spec.height;
    image.full_x = spec.full_x;
    image.full_y = spec.full_y;
    image.full_width = spec.full_width;
    image.full_height = spec.full_height;
    image.is_tiled = spec.tile_width != 0;
    const auto pixels =
        static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height);
    const auto count = static_cast<std::size_t>(spec.nchannels);
    std::vector<float> values(pixels * count);
    if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeFloat, values.data()))
        throw std::runtime_error(input->geterror());
    for (std::size_t c = 0; c < count; ++c) {
        const std::string& name = spec.channelnames[c];
        image.names.push_back(name);
        image.formats[name] = spec.channelformat(static_cast<int>(c)).c_str();
        std::vector<float>& channel = image.channels[name];
        for (std::size_t i = 0; i < pixels; ++i) channel.push_back(values[i * count + c]);
    }
    for (const OIIO::ParamValue& entry : spec.extra_attribs)
        image.metadata[entry.name().string()] = entry.get_string();
    image.images = 1;
    while (input->seek_subimage(image.images, 0)) ++image.images;
}

void uwvdb_test_write_image(const fs::path& file, int width, int height, int channels,
                            const std::vector<int>& values, int bits) {
    OIIO::ImageSpec spec(width, height, channels, bits == 16 ? OIIO::TypeUInt16 : OIIO::TypeUInt8);
    spec.attribute("oiio:UnassociatedAlpha", 1);
    // TIFF knows JPEG, too, but is to be exact.
    if (file.extension() == ".jpg") spec.attribute("Compression", "jpeg:100");
    const std::vector<std::uint8_t> bytes(values.begin(), values.end());
    const std::vector<std::uint16_t> words(values.begin(), values.end());
    const auto output = OIIO::ImageOutput::create(file.string());
    const void* const pixels = bits == 16 ? static_cast<const void*>(words.data()) : bytes.data();
    if (!output || !output->open(file.string(), spec) ||
        !output->write_image(spec.format, pixels) || !output->close())
        throw std::runtime_error("cannot write " + file.string());
}

}  // extern "C"
