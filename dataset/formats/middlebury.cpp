#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/image/image_writer.h"
#include "dataset/formats/byte_text.h"
#include "dataset/formats/formats.h"
#include "dataset/formats/stereo_pair.h"

namespace uw {

namespace {

/// Where nothing is known; readers take what is above 1e9 for it.
constexpr float k_unknown_flow = 1e10F;

/// The .flo of Middlebury's flow benchmark (Baker et al. 2011): 202021.25, width, height, then u
/// and v of each pixel, rows from the top.
std::string flo_text(const ViewImages& images, Layer layer) {
    std::string text;
    append_bytes(text, 202021.25F);
    append_bytes(text, static_cast<std::int32_t>(images.width()));
    append_bytes(text, static_cast<std::int32_t>(images.height()));
    std::vector<float> row(2 * static_cast<std::size_t>(images.width()));
    text.reserve(text.size() +
                 std::span(row).size_bytes() * static_cast<std::size_t>(images.height()));
    for (int y = 0; y < images.height(); ++y) {
        throw_if_stopped();
        auto out = row.begin();
        for (int x = 0; x < images.width(); ++x)
            for (const float value : images.at(layer, x, y).first(2))
                *out++ = std::isfinite(value) ? value : k_unknown_flow;
        append_floats(text, row);
    }
    return text;
}

/// The .pfm of Middlebury's stereo benchmarks: one channel, a negative scale for little-endian,
/// rows from the bottom, infinite where nothing is known.
std::string pfm_text(const ViewImages& images, Layer layer) {
    std::string text = fmt::format("Pf\n{} {}\n-1.0\n", images.width(), images.height());
    images.for_each_pixel([&](int x, int y) {
        const float value = images.at(layer, x, images.height() - 1 - y).front();
        append_bytes(text, std::isfinite(value) ? value : std::numeric_limits<float>::infinity());
    });
    return text;
}

/// 255 where the other image does not see the point, or there is none.
void write_occluded(const ViewImages& images, SetFiles& files, Layer layer,
                    const std::string& role) {
    DigitalImage image{images.width(), images.height(), 1, 8, false, {}};
    images.for_each_pixel([&](int x, int y) {
        image.values.push_back(images.at(layer, x, y).front() == 0 ? 0 : 255);
    });
    files.add(role, images.definition.file(images.view, role, ".png"),
              [&](const auto& file) { write_png(file, image, {}); });
}

void write_flow(const ViewImages& images, SetFiles& files) {
    if (!images.has_values(Layer::flow)) return;  // the last frame
    files.add_bytes("flow", images.definition.file(images.view, "flow", ".flo"),
                    flo_text(images, Layer::flow));
    write_occluded(images, files, Layer::flow_occluded, "flow_occluded");
}

void write_disparity(const ViewImages& images, SetFiles& files) {
    check_disparity(images);
    files.add_bytes("disparity", images.definition.file(images.view, "disparity", ".pfm"),
                    pfm_text(images, Layer::disparity));
    write_occluded(images, files, Layer::disparity_occluded, "disparity_occluded");
}

}  // namespace

DatasetFormat flow_format() {
    return {.name = "flow",
            .summary = "flow/: optical flow to the next frame, .flo, and where it is occluded",
            .card =
                "`flow/`: where the surface point of a pixel's centre is in the frame with the "
                "next number, in pixels to the right and down, as Middlebury's `.flo`; above 1e9 "
                "where nothing is seen. `flow_occluded/`: PNG, 255 where that frame does not see "
                "the point. The last frame of a sequence has neither.",
            .layers = "flow,flow_occluded",
            .check =
                [](const DatasetDefinition& definition, const SceneDesc&) {
                    if (!definition.frames.front())
                        throw UsageError(
                            "--format flow: the set has no frames; give --frames, of a scene in "
                            "which something moves");
                },
            .write_view = write_flow};
}

DatasetFormat disparity_format() {
    return {.name = "disparity",
            .summary = "disparity/: of a rectified pair, .pfm, and where it is occluded",
            .card =
                "`disparity/`: x of the point in the left image less x in the right one, in "
                "pixels, for both images, as Middlebury's `.pfm`; infinite where nothing is seen. "
                "`disparity_occluded/`: PNG, 255 where the other camera does not see the point.",
            .layers = "disparity,disparity_occluded",
            .check = check_rectified,
            .write_view = write_disparity};
}

}  // namespace uw
