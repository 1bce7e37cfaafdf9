#include "cli/render/image_output.h"

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/troubleshooting.h"
#include "core/image/deep_exr_file.h"
#include "core/image/image_file.h"
#include "core/image/jpeg_file.h"
#include "core/image/picture_file.h"
#include "core/image/pixel_image.h"
#include "core/image/png_file.h"
#include "core/image/preview_exposure.h"
#include "render/image_header.h"

namespace uw {

namespace {

std::size_t count_empty(const Film& film) {
    const PixelWindow& window = film.window();
    std::size_t empty = 0;
    for (int y = window.y0; y < window.y1; ++y) {
        throw_if_stopped();
        for (int x = window.x0; x < window.x1; ++x) empty += film.pixel(x, y)[k_alpha] == 0 ? 1 : 0;
    }
    return empty;
}

// A warning of one line if the image is black, or empty in part.
void warn_of_darkness(const PixelWindow& window, std::size_t empty, bool black,
                      const SayCallback& warn) {
    const std::size_t pixels =
        static_cast<std::size_t>(window.width()) * static_cast<std::size_t>(window.height());
    if (empty > 0)
        warn(fmt::format(
            "{} of {} {} empty (alpha 0): no ray passes through the port there, or the lens's "
            "distortion leaves none",
            empty, counted(pixels, "pixel"), empty == 1 ? "is" : "are"));
    if (black && empty < pixels)
        warn(
            "the image is black: no lamp's light reaches the camera; check the "
            "lamps' positions, directions and intensities, the camera's pose, and how far "
            "light travels in this water" +
            see_troubleshooting("Black"));
}

void warn_of_half(const HalfLoss& loss, const ExrOptions& options, const SayCallback& warn) {
    const char* const option = options.is_aces ? "--aces" : "--precision half";
    const char* const hint = options.is_aces ? "scale the lamps' intensities, or leave out --aces"
                                             : "use --precision float";
    if (loss.too_large > 0)
        warn(fmt::format("{}: {} {} too large for half floats, and infinite in the file; {}",
                         option, counted(loss.too_large, "value"),
                         loss.too_large == 1 ? "is" : "are", hint));
    if (loss.too_dark)
        warn(fmt::format("{}: the light is so weak that half floats round it visibly; {}", option,
                         hint));
}

// The light itself: an EXR, or R, G and B alone.
void write_light_of(OutputFile& out, const FinishedImage& image, const ImageStorage& storage,
                    bool with_ids) {
    if (!is_exr(out.path())) {
        write_light(out, image.film, image.metadata);
        return;
    }
    ImageMetadata metadata = image.metadata;
    if (with_ids) add_id_names(image.surfaces->names(), metadata);
    add_matte_manifests(image.surfaces->names(), image.film.channel_names(), metadata);
    write_exr(out, image.film, metadata, storage.exr);
}

void write_camera_image(OutputFile& out, const DigitalImage& image, const DevelopmentDesc& desc,
                        const ImageMetadata& metadata) {
    if (desc.format == DevelopmentDesc::Format::jpeg)
        write_jpeg_file(out, image, desc.quality, metadata);
    else
        write_png_file(out, image, metadata);
}

}  // namespace

void write_images(const OutputFiles& files, const FinishedImage& image, const ImageStorage& storage,
                  OutputGroup& outputs, const SayCallback& say, const SayCallback& warn) {
    const Film& film = image.film;
    const std::optional<double> automatic = automatic_exposure(film);
    const double exposure = storage.exposure.value_or(automatic.value_or(1.0));
    const bool with_light = !files.image.empty();
    if (with_light) write_light_of(outputs.add(files.image), image, storage, !files.ids.empty());
    if (!files.deep.empty())
        write_deep_exr_file(outputs.add(files.deep), *image.deep, film.window(), image.metadata,
                            storage.exr.compression);
    if (!files.ids.empty()) write_id_table(outputs.add(files.ids), image.surfaces->names());
    if (image.sensor)
        write_camera_image(outputs.add(files.sensor), *image.sensor, storage.camera,
                           image.metadata);
    if (!files.preview.empty())
        write_picture(outputs.add(files.preview), film,
                      {exposure, storage.preview_bits, storage.view.get()}, image.metadata);
    const std::size_t empty = count_empty(film);
    std::optional<HalfLoss> loss;
    if (with_light && storage.exr.precision == ExrOptions::Precision::half) loss = half_loss(film);
    {
        // Otherwise the EXR might be of one run and its preview of another.
        const FolderLock lock(files.main().parent_path());
        outputs.commit();
    }
    if (!files.irradiance_vdb.empty()) say(fmt::format("wrote {}", files.irradiance_vdb.string()));
    warn_of_darkness(film.window(), empty, !automatic, warn);
    if (loss) warn_of_half(*loss, storage.exr, warn);
    if (with_light) say(fmt::format("wrote {}", files.image.string()));
    if (!files.deep.empty())
        say(fmt::format("wrote {} (deep: {:.1f} samples per pixel)", files.deep.string(),
                        static_cast<double>(image.deep->sample_count()) /
                            static_cast<double>(image.deep->pixel_count())));
    if (!files.ids.empty()) say(fmt::format("wrote {} (names of ids)", files.ids.string()));
    if (image.sensor) say(fmt::format("wrote {} (the camera's image)", files.sensor.string()));
    if (files.preview.empty()) return;
    say(fmt::format("wrote {} ({}{})", files.preview.string(), with_light ? "preview, " : "",
                    automatic ? fmt::format("R G B x {:.4g}", exposure) : "black"));
}

}  // namespace uw
