#include "dataset/view_images.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/image/image_writer.h"
#include "core/image/preview.h"

namespace uw {

namespace {

constexpr std::string_view k_image_role = "image";

void write_new_image(const ViewImages& images, const std::filesystem::path& file) {
    ImageMetadata metadata = images.metadata;
    if (images.sensor) {
        write_png(file, *images.sensor, metadata);
        return;
    }
    metadata["exposure"] = images.exposures.image;
    if (images.definition.is_16_bit)
        write_png(file, make_preview16(images.film, images.exposures.image), metadata);
    else
        write_png(file, make_preview(images.film, images.exposures.image), metadata);
}

}  // namespace

bool ViewImages::has_values(Layer layer) const {
    for (int y = 0; y < height(); ++y) {
        throw_if_stopped();
        for (int x = 0; x < width(); ++x)
            if (std::isfinite(at(layer, x, y).front())) return true;
    }
    return false;
}

void write_image(const ViewImages& images, SetFiles& files, const std::string& role,
                 const std::string& path) {
    // All roles but this one's are copies in the folders of other formats.
    const auto written = std::ranges::find_if(
        files.written(), [](const SetFile& file) { return file.role.starts_with(k_image_role); });
    if (written != files.written().end()) {
        const std::string from = written->path;
        files.add_copy(role, path, from);
        return;
    }
    files.add(role, path,
              [&](const std::filesystem::path& file) { write_new_image(images, file); });
}

void write_depth(const ViewImages& images, SetFiles& files, const std::string& role,
                 const std::string& path, double scale) {
    constexpr double k_most = 65535;
    DigitalImage depth{images.width(), images.height(), 1, 16, false, {}};
    depth.values.reserve(depth.row_values() * static_cast<std::size_t>(depth.height));
    const double far = images.definition.depth_far.value_or(HUGE_VAL);
    double nearest = HUGE_VAL, farthest = 0;
    images.for_each_pixel([&](int x, int y) {
        const double z = images.at(Layer::depth, x, y).front();
        const bool is_seen = z > 0 && z <= far;
        if (is_seen) {
            nearest = std::min(nearest, z);
            farthest = std::max(farthest, z);
        }
        const double value = is_seen ? std::min(std::round(z * scale), k_most) : 0;
        depth.values.push_back(static_cast<std::uint16_t>(value));
    });
    if (std::round(farthest * scale) > k_most || std::round(nearest * scale) < 1)
        throw InputError(fmt::format(
            "{}: depths of {:.4g} to {:.4g} m do not fit into 16 bits at {:g} per metre, which "
            "hold {:.3g} to {:.4g} m; give another --depth-scale where the format leaves the "
            "choice, or --depth-far {:.4g} to leave out what is beyond",
            path, nearest, farthest, scale, 0.5 / scale, k_most / scale, k_most / scale));
    files.add(role, path, [&](const std::filesystem::path& file) {
        write_png(file, depth, {{"depth_per_metre", scale}});
    });
}

}  // namespace uw
