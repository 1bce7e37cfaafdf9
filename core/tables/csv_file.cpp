#include "core/tables/csv_file.h"

#include <fmt/format.h>

#include "core/base/text.h"
#include "core/files/text_file.h"

namespace uw {

namespace {

constexpr std::size_t k_largest_file = std::size_t{4} << 20;

}  // namespace

CsvTable read_csv_file(const std::filesystem::path& file, const std::string& where) {
    const std::string subject = fmt::format("{}: {}", where, printable(file.string(), 300));
    return CsvTable(read_text_file(file, subject, k_largest_file, "table"),
                    printable(file.filename().string(), 300));
}

}  // namespace uw
