#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include "core/base/affine.h"
#include "core/meshes/gltf/gltf_document.h"

namespace uw {

/// One node of the scene that a glTF file shows; for gltf_*.cpp only.
struct GltfNode {
    std::size_t index = 0;                 // in "nodes"
    const nlohmann::json* json = nullptr;  // of the document
    Affine file_from_node;                 // all parents' transforms and its own
};

/// What animations make of a node's own transform at a moment; the rest is as the node has it.
struct GltfPose {
    std::optional<std::array<double, 3>> translation, scale;
    std::optional<std::array<double, 4>> rotation;  // x, y, z, w, unit
};

/// By the node's index.
using GltfPoses = std::map<std::size_t, GltfPose>;

/// The nodes of the file's scene ("scene", else the first; without scenes all nodes), parents
/// before their children. Throws InputError unless they are a strict tree at most 256 deep, and for
/// a node in `poses` that has a matrix.
std::vector<GltfNode> gltf_nodes(const GltfDocument& document, const GltfPoses& poses = {});

}  // namespace uw
