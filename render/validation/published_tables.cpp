#include "render/validation/published_tables.h"

#include <stdexcept>
#include <string>

namespace uw {

CsvTable published_table(std::string_view name) {
    for (const PublishedTable& table : published_tables())
        if (table.name == name) return CsvTable(table.text, std::string(name));
    throw std::logic_error("no such table of published figures: " + std::string(name));
}

}  // namespace uw
