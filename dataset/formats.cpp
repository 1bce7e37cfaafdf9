#include "dataset/formats.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"

namespace uw {

std::span<const DatasetFormat> dataset_formats() {
    static const std::array k_formats{
        png_format(),     exr_format(),    depth_format(),      mask_format(), ids_format(),
        plume_format(),   clean_format(),  numpy_format(),      flow_format(), disparity_format(),
        kitti_format(),   colmap_format(), nerfstudio_format(), tum_format(),  euroc_format(),
        sensors_format(), mcap_format(),   calibration_format()};
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

namespace {

/// Adds the layers of `request` that a set with or without frames and rig can have.
void append_layers(std::string& layers, std::string_view request,
                   const DatasetDefinition& definition) {
    if (request.empty()) return;
    for (const std::string_view layer : split(request, ',')) {
        const bool is_missing = (layer.starts_with("flow") && !definition.frames.front()) ||
                                (layer.starts_with("disparity") && definition.cameras.size() < 2);
        if (!is_missing) layers += (layers.empty() ? "" : ",") + std::string(layer);
    }
}

}  // namespace

std::string layers_of(const DatasetDefinition& definition) {
    std::string layers;
    for (const std::string& name : definition.formats)
        append_layers(layers, dataset_format(name).layers, definition);
    if (!definition.layers.empty()) layers += (layers.empty() ? "" : ",") + definition.layers;
    return layers.empty() ? "depth" : layers;  // the least: a request of none means the default set
}

bool needs_points(const DatasetDefinition& definition) {
    return std::ranges::any_of(definition.formats, [](const std::string& name) {
        return dataset_format(name).needs_points;
    });
}

namespace {

/// The set's formats whose treatment of ports fulfils `is_meant`, in their order.
std::string formats_whose(const DatasetDefinition& definition,
                          const std::function<bool(DatasetFormat::Ports)>& is_meant) {
    std::string names;
    for (const std::string& name : definition.formats)
        if (is_meant(dataset_format(name).ports)) names += (names.empty() ? "" : ",") + name;
    return names;
}

}  // namespace

std::string fittable_formats(const DatasetDefinition& definition) {
    return formats_whose(definition, [](DatasetFormat::Ports ports) {
        return ports == DatasetFormat::Ports::fitted;
    });
}

std::string formats_in_air(const DatasetDefinition& definition) {
    return formats_whose(definition, [&](DatasetFormat::Ports ports) {
        if (ports == DatasetFormat::Ports::fitted) return !definition.pinhole_fit;
        // Several cameras in KITTI's are a pair, which has no ports (check_kitti).
        return ports == DatasetFormat::Ports::in_air && definition.cameras.size() == 1;
    });
}

void write_view(const std::filesystem::path& folder, const std::string& sum,
                const ViewImages& images) {
    SetFiles files(folder);
    for (const std::string& name : images.definition.formats)
        if (const auto write = dataset_format(name).write_view) write(images, files);
    const ViewRecord record{images.view,   sum,           images.time,   images.stamp,
                            images.camera, images.inputs, images.shared, files.written()};
    SetFiles(folder).add_bytes("record", record_file(images.definition, images.view),
                               record_text(images.definition, record));
}

std::optional<ViewRecord> complete_record(const std::filesystem::path& folder,
                                          const DatasetDefinition& definition,
                                          const std::string& sum, const View& view) {
    auto record = read_record(folder, definition, sum, view);
    if (record && !record->has_all_files(folder, true)) record.reset();
    return record;
}

}  // namespace uw
