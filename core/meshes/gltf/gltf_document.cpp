#include "core/meshes/gltf/gltf_document.h"

#include <fmt/format.h>

#include "core/base/error.h"

namespace uw {

using Json = nlohmann::json;

GltfDocument::GltfDocument(const std::filesystem::path& file)
    : file_(file), root_(load_gltf_json(file)) {}

void GltfDocument::fail(const std::string& what) const {
    throw InputError(fmt::format("{}: {}", name(), what));
}

const Json& GltfDocument::list(const Json& parent, const char* key) const {
    static const Json none = Json::array();
    const auto found = parent.is_object() ? parent.find(key) : parent.end();
    if (!parent.is_object() || found == parent.end()) return none;
    if (!found->is_array()) fail(fmt::format("glTF '{}' is not a list", key));
    return *found;
}

const Json& GltfDocument::object(const Json& parent, const char* key) const {
    static const Json none = Json::object();
    const auto found = parent.is_object() ? parent.find(key) : parent.end();
    if (!parent.is_object() || found == parent.end()) return none;
    if (!found->is_object()) fail(fmt::format("glTF '{}' is not an object", key));
    return *found;
}

const Json& GltfDocument::extension(const Json& parent, const char* key) const {
    return object(object(parent, "extensions"), key);
}

std::uint64_t GltfDocument::whole_number(const Json& parent, const char* key,
                                         std::uint64_t otherwise) const {
    const auto found = parent.find(key);
    if (found == parent.end()) return otherwise;
    if (!found->is_number_unsigned()) fail(fmt::format("glTF '{}' is not a whole number", key));
    return found->get<std::uint64_t>();
}

const Json& GltfDocument::element(const char* key, const Json& parent,
                                  const char* index_key) const {
    const Json& all = list(key);
    const std::uint64_t index = whole_number(parent, index_key, UINT64_MAX);
    if (index >= all.size())
        fail(fmt::format("glTF '{}' refers to an item that does not exist", index_key));
    return all[index];
}

}  // namespace uw
