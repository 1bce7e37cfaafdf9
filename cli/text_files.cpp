#include "cli/text_files.h"

#include <fmt/format.h>

#include <fstream>

#include "cli/console.h"
#include "core/base/error.h"

namespace uw {

void TextFiles::add(const std::filesystem::path& path, const std::string& content) {
    files_.push_back({path, std::make_unique<AtomicFile>(path)});
    std::ofstream out(files_.back().file->temporary_path(), std::ios::binary);
    out << content;
    out.close();
    if (!out) throw IoError(fmt::format("{}: cannot write; is the disk full?", path.string()));
}

void TextFiles::commit(bool quiet) {
    for (Entry& entry : files_) {
        entry.file->commit();
        if (!quiet) print_message(fmt::format("wrote {}\n", entry.path.string()));
    }
    files_.clear();
}

void write_text(const std::filesystem::path& output, const std::string& content, bool quiet) {
    if (output.empty()) {
        print_output(content);
        return;
    }
    TextFiles files;
    files.add(output, content);
    files.commit(quiet);
}

}  // namespace uw
