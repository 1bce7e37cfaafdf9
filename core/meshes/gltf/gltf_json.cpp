#include "core/meshes/gltf/gltf_json.h"

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <system_error>

#include "core/base/error.h"
#include "core/files/input_files.h"

namespace uw {
namespace {

constexpr int k_max_nesting = 100;          // more than any exporter writes
constexpr std::uint64_t k_glb_header = 20;  // magic, version, length, chunk length, chunk type

std::string read_bytes(std::ifstream& in, std::uint64_t count) {
    std::string bytes(count, '\0');
    in.read(bytes.data(), static_cast<std::streamsize>(count));
    bytes.resize(static_cast<std::size_t>(in.gcount()));
    return bytes;
}

std::uint32_t little_endian(const std::string& bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t k = 4; k-- > 0;) {
        value = (value << 8) | static_cast<unsigned char>(bytes[at + k]);
    }
    return value;
}

void check_nesting(const std::string& json, const std::string& name) {
    int depth = 0;
    bool in_string = false;
    for (std::size_t k = 0; k < json.size(); ++k) {
        const char c = json[k];
        if (in_string) {
            if (c == '\\') ++k;
            if (c == '"') in_string = false;
        } else if (c == '"') {
            in_string = true;
        } else if (c == '{' || c == '[') {
            if (++depth > k_max_nesting) throw InputError(name + ": the glTF is nested too deeply");
        } else if (c == '}' || c == ']') {
            --depth;
        }
    }
}

}  // namespace

std::string read_gltf_text(const std::filesystem::path& file) {
    const std::string name = file.string();
    std::error_code status;
    // A pipe or device under a mesh's name would block the reader.
    const bool is_file = std::filesystem::is_regular_file(file, status);
    remember_input(file);
    std::ifstream in;
    if (is_file) in.open(file, std::ios::binary);
    if (!is_file || !in)
        throw IoError(name + ": cannot open the mesh; check the name and its permissions");
    const std::uint64_t size = std::filesystem::file_size(file);
    std::string header = read_bytes(in, std::min<std::uint64_t>(size, k_glb_header));
    if (!header.starts_with("glTF")) {
        in.clear();
        in.seekg(0);
        return read_bytes(in, size);
    }
    if (header.size() < k_glb_header || little_endian(header, 4) != 2) {
        throw InputError(name + ": not a GLB file of version 2; export it as glTF 2.0");
    }
    const std::uint64_t length = little_endian(header, 12);
    if (header.substr(16, 4) != "JSON" || length > size - k_glb_header) {
        throw InputError(name + ": the GLB file is truncated; export the mesh again");
    }
    return read_bytes(in, length);
}

nlohmann::json load_gltf_json(const std::filesystem::path& file) {
    const std::string text = read_gltf_text(file);
    check_nesting(text, file.string());
    nlohmann::json document = nlohmann::json::parse(text);
    if (!document.is_object() || !document.contains("asset")) {
        throw InputError(file.string() + ": not a glTF file (it has no 'asset')");
    }
    if (!document["asset"].value("version", "").starts_with("2")) {
        throw InputError(file.string() + ": not glTF 2; export it as glTF 2.0");
    }
    return document;
}

}  // namespace uw
