#include "core/meshes/gltf/gltf_files.h"

#include "core/meshes/gltf/gltf_document.h"
#include "core/meshes/gltf/gltf_uri.h"

namespace uw {

std::vector<std::filesystem::path> files_named_by_gltf(const std::filesystem::path& file) {
    std::vector<std::filesystem::path> files;
    try {
        const GltfDocument document(file);
        for (const char* const list : {"buffers", "images"})
            for (const nlohmann::json& entry : document.list(list)) {
                const std::string uri = entry.value("uri", "");
                if (!uri.empty() && !uri.starts_with("data:"))
                    files.push_back(gltf_uri_path(file, uri));
            }
    } catch (const std::exception&) {
        return {};
    }
    return files;
}

}  // namespace uw
