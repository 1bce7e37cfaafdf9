#include "python/image_object.h"

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/image/image_writer.h"
#include "core/image/preview.h"

namespace uw {

void save(const ImageObject& image, const std::filesystem::path& file,
          std::optional<double> exposure, const ExrOptions& options) {
    if (file.extension() == ".exr") {
        write_exr(file, image.film, image.metadata, options);
        return;
    }
    if (file.extension() != ".png")
        throw UsageError(fmt::format(
            "save: {}: it is written as OpenEXR or PNG; give a name that ends in .exr or .png",
            printable(file.string(), 300)));
    ImageMetadata metadata = image.metadata;
    const double factor = exposure ? *exposure : automatic_exposure(image.film).value_or(1.0);
    metadata["exposure"] = factor;
    write_png(file, make_preview(image.film, factor), metadata);
}

}  // namespace uw
