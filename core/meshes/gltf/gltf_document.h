#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "core/meshes/gltf/gltf_json.h"

namespace uw {

/// The description in a glTF file and the ways to read it that distrust it. With nlohmann-json in
/// it, this header is for gltf_*.cpp and their headers only. What is wrong throws InputError that
/// names the file; values of the wrong kind throw nlohmann's exceptions.
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
    /// The whole number >= 0 under `key`, or `otherwise`.
    std::uint64_t whole_number(const nlohmann::json& parent, const char* key,
                               std::uint64_t otherwise) const;
    /// What `parent[index_key]` is the index of in the root's list `key`.
    const nlohmann::json& element(const char* key, const nlohmann::json& parent,
                                  const char* index_key) const;

  private:
    std::filesystem::path file_;
    nlohmann::json root_;
};

}  // namespace uw
