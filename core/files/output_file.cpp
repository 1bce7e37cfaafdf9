#include "core/files/output_file.h"

#include <fmt/format.h>

#include "core/base/error.h"

namespace uw {

OutputFile::OutputFile(const std::filesystem::path& file)
    : file_(file), atomic_(file), stream_(atomic_.temporary_path(), std::ios::binary) {}

void OutputFile::write(std::span<const std::byte> bytes) {
    stream_.write(reinterpret_cast<const char*>(bytes.data()),
                  static_cast<std::streamsize>(bytes.size()));
    position_ += bytes.size();
}

void OutputFile::seek(std::uint64_t position) {
    stream_.seekp(static_cast<std::streamoff>(position));
    position_ = position;
}

void OutputFile::complete() {
    if (stream_.is_open()) stream_.close();
    if (!stream_)
        throw IoError(fmt::format(
            "{}: cannot write: some of the data was rejected; is the disk full?", file_.string()));
}

void OutputFile::commit() {
    complete();
    atomic_.commit();
}

OutputGroup::~OutputGroup() {
    while (!files_.empty()) files_.pop_back();
}

OutputFile& OutputGroup::add(const std::filesystem::path& file) {
    return *files_.emplace_back(std::make_unique<OutputFile>(file));
}

void OutputGroup::commit() {
    for (const auto& file : files_) file->complete();
    for (const auto& file : files_) file->commit();
    files_.clear();
}

}  // namespace uw
