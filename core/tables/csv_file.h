#pragma once

#include <filesystem>
#include <string>

#include "core/tables/csv_table.h"

namespace uw {

/// Reads a CSV file of at most 4 MiB; `where` is the entry of the scene that names it. Throws
/// InputError for a file that is no such table, IoError for one that cannot be read.
CsvTable read_csv_file(const std::filesystem::path& file, const std::string& where);

}  // namespace uw
