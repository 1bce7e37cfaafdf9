#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/files/atomic_file.h"

namespace uw {

/// Text files that are created together or, if one cannot be written, not at all.
class TextFiles {
  public:
    /// Writes `content` beside `path`. Throws IoError.
    void add(const std::filesystem::path& path, const std::string& content);
    /// Gives the files their names, and prints which were written unless `quiet`. Throws IoError.
    void commit(bool quiet = false);

  private:
    struct Entry {
        std::filesystem::path path;
        std::unique_ptr<AtomicFile> file;
    };
    std::vector<Entry> files_;
};

/// Writes `content` to the file of option -o, or to standard output if its name is empty. Throws
/// IoError.
void write_text(const std::filesystem::path& output, const std::string& content,
                bool quiet = false);

}  // namespace uw
