#pragma once

#include <string>
#include <vector>

namespace uw {

/// Reads the wavelengths [nm] of --bands: a list "620,540,450" or a range "first:last:step" that
/// ends at or before `last`; 1 to 2000 of them, each once. Throws UsageError of one line.
std::vector<double> parse_bands(const std::string& text);

}  // namespace uw
