#include "core/tables/csv_file.h"

#include <fmt/format.h>

#include <fstream>
#include <system_error>

#include "core/base/error.h"
#include "core/base/text.h"

namespace uw {

namespace {

constexpr std::size_t k_largest_file = 4 << 20;

}  // namespace

CsvTable read_csv_file(const std::filesystem::path& file, const std::string& where) {
    const std::string name = printable(file.string(), 300);
    std::error_code error;
    std::ifstream stream(file, std::ios::binary);
    std::string text(k_largest_file + 1, '\0');
    if (stream) stream.read(text.data(), static_cast<std::streamsize>(text.size()));
    if (!stream.is_open() || stream.bad() || std::filesystem::is_directory(file, error))
        throw IoError(
            fmt::format("{}: cannot read {}; check its name and permissions", where, name));
    text.resize(static_cast<std::size_t>(stream.gcount()));
    if (text.size() > k_largest_file)
        throw InputError(
            fmt::format("{}: {} is larger than 4 MiB; give a table of some rows", where, name));
    return CsvTable(text, printable(file.filename().string(), 300));
}

}  // namespace uw
