#include "core/meshes/gltf/gltf_motion.h"

#include <fmt/format.h>

#include <set>
#include <vector>

#include "core/base/text.h"
#include "core/meshes/gltf/gltf_animation.h"

namespace uw {
namespace {

constexpr std::size_t k_most_listed = 6;

/// "'a', 'b' and 3 more" of nodes by index.
std::string listed_nodes(const GltfDocument& document, const std::set<std::size_t>& nodes) {
    std::string text;
    std::size_t count = 0;
    for (const std::size_t index : nodes) {
        if (count++ == k_most_listed) {
            return text + fmt::format(" and {} more", nodes.size() - k_most_listed);
        }
        std::string name = document.list("nodes")[index].value("name", "");
        if (name.empty()) name = fmt::format("node{}", index);
        text += fmt::format("{}'{}'", text.empty() ? "" : ", ", printable(name));
    }
    return text;
}

}  // namespace

std::string unused_motion_of(const GltfDocument& document, const GltfUse& use) {
    const nlohmann::json& nodes = document.list("nodes");
    std::set<std::size_t> animated, skinned;
    for (const nlohmann::json& animation : document.list("animations")) {
        for (const nlohmann::json& channel : document.list(animation, "channels")) {
            if (use.time && moves_node(document, channel)) continue;
            const std::uint64_t node =
                document.whole_number(document.object(channel, "target"), "node", UINT64_MAX);
            if (node < nodes.size()) animated.insert(node);
        }
    }
    for (std::size_t node = 0; node < nodes.size(); ++node) {
        if (nodes[node].contains("skin")) skinned.insert(node);
    }
    if (animated.empty() && skinned.empty()) return {};
    std::string what;
    if (!animated.empty())
        what = (use.time ? "morph animations of " : "animations of ") +
               listed_nodes(document, animated);
    if (!skinned.empty())
        what += fmt::format("{}skins of {}", what.empty() ? "" : " and ",
                            listed_nodes(document, skinned));
    return what + " stand still, as the file has them; to move them, export a file for each frame";
}

}  // namespace uw
