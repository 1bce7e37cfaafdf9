#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/image/exr_file.h"
#include "core/image/film.h"
#include "core/image/pixel_image.h"
#include "python/arguments.h"
#include "render/renderer.h"

namespace uw {

/// An image that was rendered, with all that is known about it.
struct ImageObject {
    Film film;
    ImageMetadata metadata;
    RenderReport report;
    std::vector<double> bands_nm;
    std::map<int, std::string> objects, materials;            // names by number
    std::map<std::string, std::vector<float>> derivatives{};  // named_derivatives
    std::optional<ViewDesc> view{};                           // that pictures are seen through
};

/// Writes it as its name's ending says: the OpenEXR that the program writes, its light,
/// or what is to be seen at this exposure, none: its own. Throws UsageError for another ending, as
/// colour_view does, and IoError.
void save(const ImageObject& image, const std::filesystem::path& file,
          std::optional<double> exposure, const ExrOptions& options);

}  // namespace uw

UWVDB_BOUND_CLASS(uw::ImageObject);
