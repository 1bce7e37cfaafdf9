#pragma once

#include <string_view>
#include <vector>

namespace uw {

/// One CSV of assets/spectra, compiled in. Line 1 of `text` is a comment with units and source.
struct EmbeddedTable {
    std::string_view name;
    std::string_view text;
};

/// All tables compiled into the program, in the order of their file names.
const std::vector<EmbeddedTable>& embedded_tables();

}  // namespace uw
