#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <functional>
#include <span>
#include <string>

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

namespace {

OIIO::TypeDesc type_of(uw::ImageValues::Type type) {
    using enum uw::ImageValues::Type;
    return type == u8 ? OIIO::TypeUInt8 : type == u16 ? OIIO::TypeUInt16 : OIIO::TypeFloat;
}

bool asks_writer_to_stop(void* is_stopped, float /*done*/) {
    return (*static_cast<const std::function<bool()>*>(is_stopped))();
}

}  // namespace

extern "C" uw::EncodeImage uwvdb_encode_image_1;

extern "C" void uwvdb_encode_image_1(const uw::ImageValues& image, const char* writer,
                                     const char* path, const std::function<bool()>& is_stopped,
                                     std::string& fault) {
    const auto output = OIIO::ImageOutput::create(writer, nullptr, "");
    if (!output) {
        fault = first_line(OIIO::geterror());
        return;
    }
    output->threads(1);
    OIIO::ImageSpec spec(image.width, image.height, image.channels, type_of(image.type));
    if (image.channels == 4) spec.alpha_channel = 3;
    if (image.is_srgb) spec.attribute("oiio:ColorSpace", "sRGB");
    if (!image.software.empty()) spec.attribute("Software", image.software);
    if (!image.description.empty()) spec.attribute("ImageDescription", image.description);
    spec.attribute("DateTime", "");  // or a TIFF would have that of today
    // The callback takes no const object.
    if (!output->open(path, spec) ||
        !output->write_image(spec.format, image.values, OIIO::AutoStride, OIIO::AutoStride,
                             OIIO::AutoStride, &asks_writer_to_stop,
                             const_cast<std::function<bool()>*>(&is_stopped)) ||
        !output->close()) {
        fault = first_line(output->geterror());
        if (fault.empty()) fault = "OpenImageIO does not say why";
    }
}
