#include <fmt/format.h>

#include "core/base/error.h"
#include "core/image/image_writer.h"
#include "dataset/formats/formats.h"
#include "render/id_table.h"

namespace uw {

namespace {

/// A grey image of what `value` says of each pixel.
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

}  // namespace uw
