#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string>

#include "core/base/error.h"
#include "core/image/image_file.h"
#include "core/image/pixel_image.h"
#include "dataset/formats.h"
#include "dataset/set_files.h"
#include "dataset/view.h"
#include "render/image_header.h"

namespace uw {

DatasetFormat png_format() {
    return {.name = "png",
            .summary = "images/: the images, as the camera's sensor stores them or as sRGB",
            .card =
                "`images/`: the images as PNG. Of a camera with a sensor they are what it stores "
                "(`camera.sensor`); else R, G and B times one exposure for the whole set, encoded "
                "as sRGB.",
            .write_view = [](const ViewImages& images, SetFiles& files) {
                write_image(images, files, "image",
                            images.definition.file(images.view, "images", ".png"));
            }};
}

DatasetFormat exr_format() {
    return {.name = "exr",
            .summary = "exr/: radiance and the layers of --layers, OpenEXR",
            .card =
                "`exr/`: OpenEXR with the radiance (W m⁻² sr⁻¹), as R G B and per band, and the "
                "layers of `--layers`, with depth by default; headers say what they are.",
            .layers = "default",
            .write_view = [](const ViewImages& images, SetFiles& files) {
                ImageMetadata metadata = images.metadata;
                add_id_names(images.surfaces->names(), metadata);
                add_matte_manifests(images.surfaces->names(), images.film.channel_names(),
                                    metadata);
                files.add("exr", images.definition.file(images.view, "exr", ".exr"),
                          [&](const auto& file) { write_exr(file, images.film, metadata); });
            }};
}

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

DatasetFormat depth_format() {
    return {.name = "depth",
            .summary = "depth/: distance along the axis, 16-bit PNG, 0 where nothing is seen",
            .card =
                "`depth/`: the distance of surfaces from the camera's centre along its axis, at "
                "the pixel's centre, as PNG of 16 bits: value = metres times the depth scale "
                "(`depth_scale` in `dataset.json`), 0 where no surface is seen. Behind a port it "
                "is the true distance, not that along the bent ray.",
            .layers = "depth",
            .write_view = [](const ViewImages& images, SetFiles& files) {
                write_depth(images, files, "depth",
                            images.definition.file(images.view, "depth", ".png"),
                            images.definition.depth_scale);
            }};
}

namespace {

/// A grey image of `value` at each pixel.
template <class Value>
DigitalImage grey_image(const ViewImages& images, int bits, const Value& value) {
    DigitalImage image{images.width(), images.height(), 1, bits, false, {}};
    image.values.reserve(image.row_values() * static_cast<std::size_t>(image.height));
    images.for_each_pixel(
        [&](int x, int y) { image.values.push_back(static_cast<std::uint16_t>(value(x, y))); });
    return image;
}

void write_mask(const ViewImages& images, SetFiles& files) {
    const DigitalImage mask = grey_image(
        images, 8, [&](int x, int y) { return images.at(Layer::id, x, y).front() > 0 ? 255 : 0; });
    files.add("mask", images.definition.file(images.view, "masks", ".png"),
              [&](const auto& file) { write_png(file, mask, {}); });
}

void write_ids(const ViewImages& images, SetFiles& files) {
    const SurfaceNames& names = images.surfaces->names();
    constexpr std::size_t k_most = 65535;
    if (names.objects.size() > k_most)
        throw InputError(fmt::format(
            "--format ids: the scene has {} objects, more than a PNG of 16 bits has numbers; use "
            "--format exr --layers id",
            names.objects.size()));
    const DigitalImage ids =
        grey_image(images, 16, [&](int x, int y) { return images.at(Layer::id, x, y).front(); });
    ImageMetadata metadata;
    add_id_names(names, metadata);
    files.add("ids", images.definition.file(images.view, "ids", ".png"),
              [&](const auto& file) { write_png(file, ids, metadata); });
    if (images.view.frame == 0 && images.view.camera == 0)
        files.add("id_names", images.definition.folder(images.view.draw) + "ids/names.csv",
                  [&](const auto& file) {
                      OutputFile out(file);
                      write_id_table(out, names);
                      out.commit();
                  });
}

}  // namespace

DatasetFormat mask_format() {
    return {.name = "mask",
            .summary = "masks/: 8-bit PNG, 255 where a surface is seen, 0 where only water is",
            .card =
                "`masks/`: PNG of 8 bits, 255 where the pixel's centre sees a surface and 0 where "
                "it sees nothing but water.",
            .layers = "id",
            .write_view = write_mask};
}

DatasetFormat ids_format() {
    return {.name = "ids",
            .summary = "ids/: numbers of objects, 16-bit PNG, and their names, CSV",
            .card =
                "`ids/`: the number of the object that the pixel's centre sees, as PNG of 16 bits, "
                "0 for none. `ids/names.csv` names the objects, and so does each image's "
                "text `uwvdb/id_names`, which counts where meshes are one file for each frame.",
            .layers = "id",
            .write_view = write_ids};
}

DatasetFormat plume_format() {
    return {.name = "plume",
            .summary = "plume/: the opacity of the plume as a mask, 8-bit PNG",
            .card =
                "`plume/`: the opacity of the volumes' particles up to the surface behind them, "
                "along the ray of the pixel's centre, as PNG of 8 bits: 255 where nothing is seen "
                "through them, the mean of the bands.",
            .layers = "plume.opacity",
            .write_view = [](const ViewImages& images, SetFiles& files) {
                const DigitalImage mask = grey_image(images, 8, [&](int x, int y) {
                    return std::lround(255 * images.at(Layer::plume_opacity, x, y).front());
                });
                files.add("plume", images.definition.file(images.view, "plume", ".png"),
                          [&](const auto& file) { write_png(file, mask, {}); });
            }};
}

namespace {

void write_clean(const ViewImages& images, SetFiles& files) {
    const Film film = clean_film(images.film, images.plan, images.colour, images.bands_nm);
    files.add("clean", images.definition.file(images.view, "clean", ".png"), [&](const auto& file) {
        write_picture_of(images, film, images.exposures.clean, file);
    });
}

}  // namespace

DatasetFormat clean_format() {
    return {.name = "clean",
            .summary = "clean/: the same images without water, for restoration; brings png along",
            .card =
                "`clean/`: the same views without the water: no absorption, no scattering, the "
                "same lamps and refraction, as sRGB. With `images/` they are pairs for "
                "restoration, pixel by pixel. As water takes most of the light, they have an "
                "exposure of their own, one for the whole set, unless `--exposure` gives both.",
            .layers = "clean",
            .needs_images = true,
            .write_view = write_clean};
}

}  // namespace uw
