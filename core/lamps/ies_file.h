#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace uw {

/// A luminaire's photometry as an IES file (LM-63 of 1986, 1991, 1995, 2002 and later) has it, type
/// C: the vertical angle is 0 at the luminaire's main axis, the horizontal one runs around it.
struct IesFile {
    int year = 1986;             // of the standard that the first line names
    double lumens = 0;           // of all lamps; negative: not told (absolute photometry)
    std::vector<double> polar;   // vertical angles [deg], strictly ascending within 0..180
    std::vector<double> planes;  // horizontal angles [deg], strictly ascending within 0..360
    /// Candelas with every factor of the file applied, plane by plane: [plane][polar].
    std::vector<double> candelas;
    std::vector<std::string> warnings;  // one line each
};

/// Reads the text of an IES file; `name` is what messages call it. Throws InputError of one line:
/// the file, the line, what is wrong (photometry of type A or B, counts that the numbers do not
/// bear out, angles that do not ascend, ...) and how to mend it.
IesFile parse_ies(std::string_view text, const std::string& name);

/// Likewise of a file of at most 4 MiB. Throws IoError where it cannot be read.
IesFile read_ies(const std::filesystem::path& file);

}  // namespace uw
