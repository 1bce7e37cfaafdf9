#include "tests/support/image_file.h"

#include <OpenImageIO/imageio.h>

#include <stdexcept>

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
    return image;
}

}  // namespace uw::test
