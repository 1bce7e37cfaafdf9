#pragma once

#include <filesystem>
#include <optional>

#include "core/meshes/gltf/gltf_bytes.h"
#include "core/meshes/gltf/gltf_nodes.h"
#include "core/scene/geometry_desc.h"

namespace uw {

/// Where the file's animations have its nodes at `time` [s] (glTF 2.0, section 3.11): all of them
/// at once; where several move the same part of a node, the first does. Before and after its keys a
/// node stays where the nearest of them has it. Throws InputError for a sampler without keys, with
/// times that do not ascend, or with values that do not fit. `document` has passed inspect_gltf.
/// For gltf_*.cpp only.
GltfPoses gltf_poses(const GltfDocument& document, GltfBytes& bytes, double time);

/// Whether a channel moves a node, and not, say, the weights of morph targets. For gltf_*.cpp only.
bool moves_node(const GltfDocument& document, const nlohmann::json& channel);

}  // namespace uw
