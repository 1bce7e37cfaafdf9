#include <algorithm>

#include "core/base/spectrum.h"
#include "core/colour/colour_response.h"
#include "core/image/image_writer.h"
#include "core/image/preview.h"
#include "dataset/formats/formats.h"

namespace uw {

namespace {

/// The layer `clean` as a film of its own, in the image's colours.
Film clean_film(const ViewImages& images) {
    const BandColour colour = make_band_colour(images.colour, images.bands_nm);
    Film film(images.width(), images.height(), images.film.window(), {"R", "G", "B", "A"});
    Spectrum radiance{};
    for (int y = 0; y < images.height(); ++y)
        for (int x = 0; x < images.width(); ++x) {
            const std::span<const float> clean = images.at(Layer::clean, x, y);
            std::copy_n(clean.begin(), images.bands_nm.size(), radiance.begin());
            const LinearRgb rgb = colour(radiance);
            const std::span<float> pixel = film.pixel(x, y);
            std::ranges::transform(rgb, pixel.begin(),
                                   [](double v) { return static_cast<float>(v); });
            pixel[k_alpha] = images.film.pixel(x, y)[k_alpha];
        }
    return film;
}

void write_clean(const ViewImages& images, SetFiles& files) {
    const Film film = clean_film(images);
    ImageMetadata metadata = images.metadata;
    metadata["exposure"] = images.exposure;
    files.add("clean", images.definition.file(images.view, "clean", ".png"), [&](const auto& file) {
        if (images.definition.is_16_bit)
            write_png(file, make_preview16(film, images.exposure), metadata);
        else
            write_png(file, make_preview(film, images.exposure), metadata);
    });
}

}  // namespace

DatasetFormat clean_format() {
    return {.name = "clean",
            .summary = "clean/: the same images without water, for restoration; brings png along",
            .card =
                "`clean/`: the same views without the water: no absorption, no scattering, the "
                "same lamps, refraction and exposure, as sRGB. With `images/` they are pairs for "
                "restoration, pixel by pixel.",
            .layers = "clean",
            .needs_images = true,
            .write_view = write_clean};
}

}  // namespace uw
