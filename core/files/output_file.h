#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "core/files/atomic_file.h"

namespace uw {

/// A binary file that appears under its name only once it is complete: write, then commit. If any
/// of it cannot be written, commit() throws, and nothing before.
class OutputFile {
  public:
    /// Throws as AtomicFile's constructor.
    explicit OutputFile(const std::filesystem::path& file);

    void write(std::span<const std::byte> bytes);
    void write(std::string_view bytes) { write(std::as_bytes(std::span(bytes))); }
    /// Where the next bytes go, from the beginning of the file.
    std::uint64_t position() const { return position_; }
    void seek(std::uint64_t position);

    const std::filesystem::path& path() const { return file_; }

    /// Throws IoError unless the file is complete; it bears its name once it is committed.
    void complete();
    /// Throws IoError unless the file is complete and bears its name.
    void commit();

  private:
    std::filesystem::path file_;
    AtomicFile atomic_;
    std::ofstream stream_;
    std::uint64_t position_ = 0;
};

/// Files that belong together: none appears under its name before all of them are complete.
class OutputGroup {
  public:
    OutputGroup() = default;
    /// Folders that were made for files that are not committed are removed with the first of them.
    ~OutputGroup();
    OutputGroup(const OutputGroup&) = delete;
    OutputGroup& operator=(const OutputGroup&) = delete;
    OutputGroup(OutputGroup&&) = default;
    OutputGroup& operator=(OutputGroup&&) = default;

    /// A file of the group, as long as that lives. Throws as AtomicFile's constructor.
    OutputFile& add(const std::filesystem::path& file);

    /// Throws IoError unless all files are complete and bear their names.
    void commit();

  private:
    std::vector<std::unique_ptr<OutputFile>> files_;
};

}  // namespace uw
