#include "dataset/formats/formats.h"

namespace uw {

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

}  // namespace uw
