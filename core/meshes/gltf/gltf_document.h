#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "core/meshes/gltf/gltf_json.h"

namespace uw {

/// A glTF file's JSON description, with accessors that do not trust it. Includes nlohmann-json, so
/// this header is for gltf_*.cpp and their headers only. Errors throw an InputError that names the
/// file; values of the wrong type throw nlohmann's exceptions.
class GltfDocument {
  public:
    /// Reads the file's JSON (load_gltf_json).
    explicit GltfDocument(const std::filesystem::path& file);

    const nlohmann::json& root() const { return root_; }
    const std::filesystem::path& file() const { return file_; }
    std::string name() const { return file_.string(); }

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

}  // namespace uw
