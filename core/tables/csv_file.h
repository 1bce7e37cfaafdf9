#pragma once

#include <filesystem>
#include <string>

#include "core/tables/csv_table.h"

namespace uw {

/// Reads a CSV file of at most 4 MiB; `where` is the scene entry that names it. Throws InputError
/// if the file is not a valid table, IoError if it cannot be read.
CsvTable read_csv_file(const std::filesystem::path& file, const std::string& where);

}  // namespace uw
