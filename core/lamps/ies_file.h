#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace uw {

/// A luminaire's type C photometry as stored in an IES file (LM-63 of 1986, 1991, 1995, 2002 and
/// later): the vertical angle is measured from the luminaire's main axis, the horizontal angle
/// around it.
struct IesFile {
    int year = 1986;             // of the standard named in the first line
    double lumens = 0;           // of all lamps; negative: not given (absolute photometry)
    std::vector<double> polar;   // vertical angles [deg], strictly ascending within 0..180
    std::vector<double> planes;  // horizontal angles [deg], strictly ascending within 0..360
    /// Candelas with every factor of the file applied, plane by plane: [plane][polar].
    std::vector<double> candelas;
    std::vector<std::string> warnings;  // one line each
};

/// Parses the text of an IES file; messages refer to it as `name`. Throws a one-line InputError
/// that states the file, the line, what is wrong (photometry of type A or B, counts that do not
/// match the data, angles that do not ascend, ...) and how to fix it.
IesFile parse_ies(std::string_view text, const std::string& name);

/// The same for a file of at most 4 MiB. Throws IoError if it cannot be read.
IesFile read_ies(const std::filesystem::path& file);

}  // namespace uw
