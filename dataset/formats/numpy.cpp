#include <fmt/format.h>

#include <array>
#include <string>

#include "dataset/formats/byte_text.h"
#include "dataset/formats/formats.h"

namespace uw {

namespace {

/// The header of NumPy's format, version 1.0: a Python dictionary, padded so that the values begin
/// at a multiple of 64 bytes.
std::string numpy_header(int height, int width, std::size_t channels) {
    const std::string shape = channels == 1 ? fmt::format("({}, {})", height, width)
                                            : fmt::format("({}, {}, {})", height, width, channels);
    std::string dictionary =
        fmt::format("{{'descr': '<f4', 'fortran_order': False, 'shape': {}, }}", shape);
    constexpr std::size_t k_before = 10, k_alignment = 64;
    while ((k_before + dictionary.size() + 1) % k_alignment != 0) dictionary += ' ';
    dictionary += '\n';
    std::string header = "\x93NUMPY";
    header += '\x01';
    header += '\x00';
    append_bytes(header, static_cast<std::uint16_t>(dictionary.size()));
    return header + dictionary;
}

std::string numpy_text(const ViewImages& images, std::size_t first, std::size_t channels) {
    std::string text = numpy_header(images.height(), images.width(), channels);
    images.for_each_pixel([&](int x, int y) {
        append_floats(text, images.film.pixel(x, y).subspan(first, channels));
    });
    return text;
}

/// The number of consecutive channels of the layer that begins at `first`.
std::size_t channels_of(const LayerPlan& plan, std::size_t first) {
    const std::vector<std::string>& names = plan.channel_names();
    const auto layer = [&](std::size_t i) { return names[i].substr(0, names[i].rfind('.')); };
    std::size_t end = first + 1;
    while (end < names.size() && layer(end) == layer(first)) ++end;
    return end - first;
}

void write_arrays(const ViewImages& images, SetFiles& files) {
    const auto add = [&](const std::string& layer, std::size_t first, std::size_t channels) {
        files.add_bytes("npy." + layer, images.definition.file(images.view, "npy/" + layer, ".npy"),
                        numpy_text(images, first, channels));
    };
    constexpr std::size_t k_rgb = 3;
    add("rgb", 0, k_rgb);
    for (std::size_t i = k_alpha + 1; i < images.plan.channel_names().size();) {
        const std::string& name = images.plan.channel_names()[i];
        const std::size_t channels = channels_of(images.plan, i);
        add(name.substr(0, name.rfind('.')), i, channels);
        i += channels;
    }
}

}  // namespace

DatasetFormat numpy_format() {
    return {.name = "npy",
            .summary = "npy/LAYER/: radiance and the layers of --layers, NumPy",
            .card =
                "`npy/`: arrays of NumPy, 32-bit floats, height × width (× channels), one folder "
                "per layer: `rgb` is the radiance (W m⁻² sr⁻¹) as R, G, B, the others are those "
                "of `--layers` and of the other formats; lengths in metres, flow in pixels, NaN "
                "where there is none.",
            .layers = "depth",
            .write_view = write_arrays};
}

}  // namespace uw
