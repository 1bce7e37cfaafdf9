#include "core/meshes/gltf/gltf_time_range.h"

#include <algorithm>
#include <cmath>
#include <exception>

#include "core/meshes/gltf/gltf_animation.h"

namespace uw {
namespace {

using Json = nlohmann::json;

/// The first or last time of a sampler, which the format requires beside its keys.
double bound_of(const Json& input, const char* key) {
    return input.at(key).at(0).get<double>();
}

std::optional<TimeRange> time_range_of(const GltfDocument& document) {
    std::optional<TimeRange> range;
    for (const Json& animation : document.list("animations"))
        for (const Json& channel : document.list(animation, "channels")) {
            if (!moves_node(document, channel)) continue;
            const Json& sampler = document.list(animation, "samplers")
                                      .at(document.whole_number(channel, "sampler", 0));
            const Json& input = document.element("accessors", sampler, "input");
            const TimeRange keys{bound_of(input, "min"), bound_of(input, "max")};
            if (!range) range = keys;
            range = {std::min(range->first, keys.first), std::max(range->last, keys.last)};
        }
    return range;
}

}  // namespace

std::optional<TimeRange> gltf_time_range(const std::filesystem::path& file) {
    try {
        // Without the word there is no need to parse what may be 100 MB.
        if (read_gltf_text(file).find("\"animations\"") == std::string::npos) return std::nullopt;
        return time_range_of(GltfDocument(file));
    } catch (const std::exception&) {
        return std::nullopt;
    }
}

}  // namespace uw
