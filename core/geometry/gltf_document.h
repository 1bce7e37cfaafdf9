#pragma once

#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace uw {

/// The file that a relative URI in `gltf_file` refers to (percent-decoded).
std::filesystem::path gltf_uri_path(const std::filesystem::path& gltf_file, const std::string& uri);

/// The "uri" of a buffer or an image, which may be as long as the file; empty if it has none.
/// Throws nlohmann's exceptions if it is no text.
const std::string& gltf_uri(const nlohmann::json& entry);

/// The text of a .gltf file, or of the first chunk of a .glb file. Throws IoError, InputError.
std::string read_gltf_text(const std::filesystem::path& file);

/// The JSON of a .gltf file, or of the first chunk of a .glb file (glTF 2.0, section 4.4). Throws
/// IoError, InputError (not glTF 2, truncated, nested too deeply), nlohmann's exceptions. Includes
/// nlohmann-json, so this header is for gltf_*.cpp only. Long data URIs are kept in buffers and
/// images; elsewhere, where they are unused, a short placeholder replaces them.
nlohmann::json load_gltf_json(const std::filesystem::path& file);

/// Throws nlohmann's error about a file as an InputError.
[[noreturn]] void fail_broken_gltf(const std::filesystem::path& file,
                                   const nlohmann::json::exception& error);

/// Whether `transmission`, the KHR_materials_transmission of a material, makes it glass: most of
/// the light that is not reflected passes.
inline bool is_gltf_glass(const nlohmann::json& transmission) {
    return transmission.value("transmissionFactor", 0.0) >= 0.5;
}

/// A glTF file's JSON description, with accessors that do not trust it. Includes nlohmann-json, so
/// this header is for gltf_*.cpp and their headers only. Errors throw an InputError that names the
/// file; values of the wrong type throw nlohmann's exceptions.
class GltfDocument {
  public:
    /// Reads the file's JSON (load_gltf_json).
    explicit GltfDocument(const std::filesystem::path& file);

    const nlohmann::json& root() const { return root_; }
    const std::filesystem::path& file() const { return file_; }
    /// Its file, for messages.
    std::string name() const;

    /// Throws InputError "<file>: <what>".
    [[noreturn]] void fail(const std::string& what) const;

    /// The array under `key`; empty if there is none.
    const nlohmann::json& list(const nlohmann::json& parent, const char* key) const;
    const nlohmann::json& list(const char* key) const { return list(root_, key); }
    /// The object under `key`; empty if there is none.
    const nlohmann::json& object(const nlohmann::json& parent, const char* key) const;
    /// The extension `key` of `parent`; an empty object if it has none.
    const nlohmann::json& extension(const nlohmann::json& parent, const char* key) const;
    /// The non-negative integer under `key`, or `otherwise`.
    std::uint64_t whole_number(const nlohmann::json& parent, const char* key,
                               std::uint64_t otherwise) const;
    /// The element of the root's list `key` with index `parent[index_key]`.
    const nlohmann::json& element(const char* key, const nlohmann::json& parent,
                                  const char* index_key) const;

  private:
    std::filesystem::path file_;
    nlohmann::json root_;
};

/// The type of an accessor's numbers: its componentType (glTF 2.0, section 3.6.2.2).
enum : std::uint64_t {
    k_gltf_byte = 5120,
    k_gltf_unsigned_byte = 5121,
    k_gltf_short = 5122,
    k_gltf_unsigned_short = 5123,
    k_gltf_unsigned_int = 5125,
    k_gltf_float = 5126,
};

/// The bytes of a glTF document: buffers in the .glb itself, in files beside it, or embedded in its
/// text. For gltf_*.cpp only. The document has passed inspect_gltf, which checks sizes.
class GltfBytes {
  public:
    /// Refers to `document`. Buffers are loaded on first use.
    explicit GltfBytes(const GltfDocument& document)
        : document_(document), buffers_(document.list("buffers").size()) {}

    /// The bytes of the view that `parent` names under `key`. Throws IoError, InputError.
    std::span<const std::byte> view(const nlohmann::json& parent, const char* key);

    /// An accessor's values as consecutive floats, `width` per element, padded with zeros. Integers
    /// are normalised if the accessor specifies it.
    std::vector<float> floats(const nlohmann::json& accessor, std::size_t width);

    /// The vertex indices of an index accessor.
    std::vector<std::uint32_t> indices(const nlohmann::json& accessor);

  private:
    const std::vector<std::byte>& buffer(std::size_t index);

    const GltfDocument& document_;
    std::vector<std::vector<std::byte>> buffers_;  // empty until loaded
};

/// The bytes encoded in a "data:...;base64," URI. Throws InputError (through `document`).
std::vector<std::byte> decode_data_uri(const GltfDocument& document, const std::string& uri);

/// Numbers per element of an accessor's type; 0 for an unknown one.
std::size_t gltf_component_count(const std::string& type);
/// Bytes of a component type's number; 0 for an unknown one.
std::size_t gltf_component_size(std::uint64_t component_type);

}  // namespace uw
