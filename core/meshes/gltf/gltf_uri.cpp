#include "core/meshes/gltf/gltf_uri.h"

#include <charconv>

namespace uw {

std::filesystem::path gltf_uri_path(const std::filesystem::path& gltf_file,
                                    const std::string& uri) {
    std::string decoded;
    for (std::size_t k = 0; k < uri.size(); ++k) {
        unsigned code = 0;
        const char* digits = uri.data() + k + 1;
        if (uri[k] == '%' && k + 2 < uri.size() &&
            std::from_chars(digits, digits + 2, code, 16).ptr == digits + 2) {
            decoded.push_back(static_cast<char>(code));
            k += 2;
        } else {
            decoded.push_back(uri[k]);
        }
    }
    return gltf_file.parent_path() / decoded;
}

}  // namespace uw
