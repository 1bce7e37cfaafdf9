#include "dataset/formats/formats.h"

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

}  // namespace uw
