#include "core/image/output_file.h"

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

void OutputFile::commit() {
    stream_.close();
    if (!stream_)
        throw IoError(fmt::format(
            "{}: cannot write: some of the data was rejected; is the disk full?", file_.string()));
    atomic_.commit();
}

}  // namespace uw
