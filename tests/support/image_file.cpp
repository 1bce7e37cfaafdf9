#include "tests/support/image_file.h"

#include <OpenImageIO/imageio.h>

#include <cstdint>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "tests/support/temp_dir.h"

namespace uw::test {

ImageFile read_exr(const std::filesystem::path& file) {
    const auto input = OIIO::ImageInput::open(file.string());
    if (!input) throw std::runtime_error(OIIO::geterror());
    const OIIO::ImageSpec& spec = input->spec();
    ImageFile image{spec.x,           spec.y, spec.width, spec.height, spec.full_width,
                    spec.full_height, {},     {},         {}};
    const auto pixels =
        static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height);
    const auto count = static_cast<std::size_t>(spec.nchannels);
    std::vector<float> values(pixels * count);
    if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeFloat, values.data()))
        throw std::runtime_error(input->geterror());
    for (std::size_t c = 0; c < count; ++c) {
        image.names.push_back(spec.channelnames[c]);
        std::vector<float>& channel = image.channels[spec.channelnames[c]];
        for (std::size_t i = 0; i < pixels; ++i) channel.push_back(values[i * count + c]);
    }
    for (const OIIO::ParamValue& entry : spec.extra_attribs)
        image.metadata[entry.name().string()] = entry.get_string();
    image.metadata["format of values"] = spec.format.c_str();
    return image;
}

std::string encoded_image(const std::string& extension, int width, int height, int channels,
                          const std::vector<int>& values, int bits) {
    const TempDir folder;
    const std::string file = (folder.path() / ("image." + extension)).string();
    OIIO::ImageSpec spec(width, height, channels, bits == 16 ? OIIO::TypeUInt16 : OIIO::TypeUInt8);
    spec.attribute("oiio:UnassociatedAlpha", 1);
    // TIFF knows JPEG, too, but is to be exact.
    if (extension == "jpg") spec.attribute("Compression", "jpeg:100");
    const std::vector<std::uint8_t> bytes(values.begin(), values.end());
    const std::vector<std::uint16_t> words(values.begin(), values.end());
    const auto output = OIIO::ImageOutput::create(file);
    const void* const pixels = bits == 16 ? static_cast<const void*>(words.data()) : bytes.data();
    if (!output || !output->open(file, spec) || !output->write_image(spec.format, pixels) ||
        !output->close())
        throw std::runtime_error("cannot write " + file);
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace uw::test
