#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/base/vector_math.h"
#include "core/geometry/gltf_document.h"
#include "core/geometry/mesh.h"
#include "core/scene/geometry_desc.h"

namespace uw {

/// One node of the scene that a glTF file shows; for gltf_*.cpp only.
struct GltfNode {
    std::size_t index = 0;                 // in "nodes"
    const nlohmann::json* json = nullptr;  // of the document
    Affine file_from_node;                 // all parents' transforms and its own
};

/// The parts of a node's own transform, and the weights of its mesh's morph targets, that
/// animations replace at a moment.
struct GltfPose {
    std::optional<std::array<double, 3>> translation, scale;
    std::optional<std::array<double, 4>> rotation;  // x, y, z, w, unit
    std::optional<std::vector<double>> weights;
};

/// By the node's index.
using GltfPoses = std::map<std::size_t, GltfPose>;

/// The nodes of the file's scene ("scene", else the first; without scenes all nodes), parents
/// before their children. Throws InputError unless they are a strict tree at most 256 deep, and for
/// a node in `poses` that has a matrix.
std::vector<GltfNode> gltf_nodes(const GltfDocument& document, const GltfPoses& poses = {});

/// The poses of the nodes at `time` [s] by the file's animations (glTF 2.0, section 3.11): all of
/// them together; if several move the same part of a node, the first one counts. Before its first
/// and after its last key a node keeps the pose of that key. Throws InputError for a sampler
/// without keys, with times that do not ascend, or with values that do not fit. `document` has
/// passed inspect_gltf. For gltf_*.cpp only.
GltfPoses gltf_poses(const GltfDocument& document, GltfBytes& bytes, double time);

/// How many morph targets the mesh of a node has, by its first primitive: 0 without a mesh. For
/// gltf_*.cpp only.
std::size_t gltf_target_count(const GltfDocument& document, const nlohmann::json& node);

/// Whether a channel moves a node, or its vertices by the weights of morph targets. For gltf_*.cpp
/// only.
bool moves_node(const GltfDocument& document, const nlohmann::json& channel);

/// A warning, without the file's name, about parts of a file that should move but do not here: the
/// targets of animations, unless they move at the time of `use`. Empty if there are none. For
/// gltf_*.cpp only.
std::string unused_motion_of(const GltfDocument& document, const GltfUse& use);

}  // namespace uw
