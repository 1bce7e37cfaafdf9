#pragma once

#include <cstddef>
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

/// The nodes of the file's scene ("scene", else the first; without scenes all nodes), parents
/// before their children. Throws InputError unless they are a strict tree at most 256 deep.
std::vector<GltfNode> gltf_nodes(const GltfDocument& document);

}  // namespace uw
