#include "core/image/image_writer.h"
#include "core/image/preview.h"
#include "dataset/formats/clean_film.h"
#include "dataset/formats/formats.h"

namespace uw {

namespace {

void write_clean(const ViewImages& images, SetFiles& files) {
    const Film film = clean_film(images.film, images.plan, images.colour, images.bands_nm);
    const double exposure = images.exposures.clean;
    ImageMetadata metadata = images.metadata;
    metadata["exposure"] = exposure;
    files.add("clean", images.definition.file(images.view, "clean", ".png"), [&](const auto& file) {
        if (images.definition.is_16_bit)
            write_png(file, make_preview16(film, exposure), metadata);
        else
            write_png(file, make_preview(film, exposure), metadata);
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
