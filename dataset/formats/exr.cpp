#include "core/image/image_writer.h"
#include "dataset/formats/formats.h"
#include "render/id_table.h"

namespace uw {

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
                files.add("exr", images.definition.file(images.view, "exr", ".exr"),
                          [&](const auto& file) { write_exr(file, images.film, metadata); });
            }};
}

}  // namespace uw
