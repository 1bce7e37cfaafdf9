#include "core/meshes/gltf/gltf_placements.h"

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/meshes/gltf/gltf_animation.h"
#include "core/meshes/gltf/gltf_inspection.h"

namespace uw {

std::vector<Affine> gltf_placements(const std::filesystem::path& file, double time) {
    try {
        const GltfDocument document(file);
        inspect_gltf(document, {});  // the accessors
        GltfBytes bytes(document);
        std::vector<Affine> placements;
        for (const GltfNode& node : gltf_nodes(document, gltf_poses(document, bytes, time)))
            if (node.json->contains("mesh")) placements.push_back(node.file_from_node);
        return placements;
    } catch (const nlohmann::json::exception& error) {
        throw InputError(
            fmt::format("{}: the glTF description is broken: {}", file.string(), error.what()));
    }
}

}  // namespace uw
