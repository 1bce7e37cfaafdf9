#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/json/json.h"

namespace uw {

/// A file of a data set that has been written.
struct SetFile {
    std::string role;  // what it is of its view: "image", "depth"
    std::string path;  // relative to the set's folder, with slashes
    std::uint64_t bytes = 0;
    std::string sha256;

    friend bool operator==(const SetFile&, const SetFile&) = default;
};

Json set_file_json(const SetFile& file);
/// Throws Json::exception.
SetFile set_file_from_json(const Json& json);

/// Whether the file is in the set's folder as it was written: of its size and, with `by_content`,
/// with its checksum.
bool is_whole(const std::filesystem::path& folder, const SetFile& file, bool by_content);

/// Writes files of a data set, each whole or not at all, and keeps a list of them.
class SetFiles {
  public:
    explicit SetFiles(std::filesystem::path folder) : folder_(std::move(folder)) {}

    /// Has `write` write the file of this name. Throws IoError, and what `write` throws.
    void add(std::string role, std::string path,
             const std::function<void(const std::filesystem::path& file)>& write);
    /// Writes a file of these bytes. Throws IoError.
    void add_bytes(std::string role, std::string path, std::string_view bytes);
    /// Writes the bytes of another file of the set. Throws IoError.
    void add_copy(std::string role, std::string path, const std::string& from);
    /// Lists a file that is there already.
    void take(SetFile file) { written_.push_back(std::move(file)); }

    const std::vector<SetFile>& written() const { return written_; }
    const std::filesystem::path& folder() const { return folder_; }

  private:
    std::filesystem::path folder_;
    std::vector<SetFile> written_;
};

}  // namespace uw
