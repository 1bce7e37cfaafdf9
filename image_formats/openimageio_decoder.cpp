#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include "core/image/image_formats.h"

namespace {

std::string first_line(const std::string& text) {
    return text.substr(0, text.find('\n'));
}

// The colour and alpha of an image that may have layers besides.
int channels_to_read(const OIIO::ImageSpec& spec) {
    if (spec.nchannels < 3) return spec.alpha_channel == 1 ? 2 : 1;
    return spec.alpha_channel == 3 ? 4 : 3;
}

bool is_linear(const OIIO::ImageSpec& spec) {
    return spec.format.is_floating_point() ||
           spec.get_string_attribute("oiio:ColorSpace") == "Linear";
}

bool asks_to_stop(void* receiver, float /*done*/) {
    return static_cast<const uw::ImageReceiver*>(receiver)->is_stopped();
}

}  // namespace

extern "C" uw::DecodeImage uwvdb_decode_image_1;

extern "C" void uwvdb_decode_image_1(std::span<const std::byte> encoded, const char* reader,
                                     const uw::ImageReceiver& receiver, std::string& fault) {
    OIIO::Filesystem::IOMemReader memory(encoded.data(), encoded.size());
    // By its format's reader alone: not every one that could be found is to see a stranger's file.
    const auto input = OIIO::ImageInput::create(reader, false, nullptr, nullptr, "");
    if (!input || !input->supports("ioproxy")) {
        fault = "OpenImageIO has no reader for it";
        return;
    }
    input->threads(1);
    OIIO::ImageSpec config, spec;
    config.attribute("oiio:UnassociatedAlpha", 1);
    input->set_ioproxy(&memory);
    if (!input->open(std::string("image.") + reader, spec, config)) {
        fault = first_line(input->geterror());
        return;
    }
    if (spec.x != spec.full_x || spec.y != spec.full_y || spec.width != spec.full_width ||
        spec.height != spec.full_height || spec.depth > 1 || spec.deep) {
        fault = "not all of the image is stored, or it is deep";
        return;
    }
    const int channels = channels_to_read(spec);
    float* const pixels = receiver.allocate(spec.width, spec.height, channels, is_linear(spec));
    // The callback takes no const object.
    if (!input->read_image(0, 0, 0, channels, OIIO::TypeFloat, pixels, OIIO::AutoStride,
                           OIIO::AutoStride, OIIO::AutoStride, &asks_to_stop,
                           const_cast<uw::ImageReceiver*>(&receiver)) ||
        input->has_error())  // a TIFF that ends early is read "well"
        fault = first_line(input->geterror());
}
