#include "dataset/formats/format_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"
#include "dataset/formats/formats.h"

namespace uw {

std::span<const DatasetFormat> dataset_formats() {
    static const std::array k_formats{png_format(),   exr_format(),    depth_format(),
                                      mask_format(),  ids_format(),    clean_format(),
                                      numpy_format(), flow_format(),   disparity_format(),
                                      kitti_format(), colmap_format(), nerfstudio_format(),
                                      tum_format(),   euroc_format(),  calibration_format()};
    return k_formats;
}

const DatasetFormat& dataset_format(std::string_view name) {
    const std::span<const DatasetFormat> formats = dataset_formats();
    const auto found = std::ranges::find(formats, name, &DatasetFormat::name);
    if (found != formats.end()) return *found;
    std::vector<std::string_view> names;
    for (const DatasetFormat& format : formats) names.push_back(format.name);
    throw UsageError(
        fmt::format("--format: unknown '{}'; {}", printable(name), suggestion(name, names)));
}

}  // namespace uw
