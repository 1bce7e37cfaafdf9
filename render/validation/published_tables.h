#pragma once

#include <string_view>
#include <vector>

#include "core/base/csv_table.h"

namespace uw {

/// One of the files of assets/published, compiled in: figures that others have published or
/// measured, with their source in the first lines; or CITATION.cff.
struct PublishedTable {
    std::string_view name;
    std::string_view text;
};
const std::vector<PublishedTable>& published_tables();
const std::vector<PublishedTable>& citation_files();

/// The one called `name`; an unknown name is a bug in the program: std::logic_error.
CsvTable published_table(std::string_view name);

}  // namespace uw
