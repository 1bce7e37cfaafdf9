#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "render/measures/lamp_numbers.h"

namespace uw {

/// One number of a part of an image, by the name that it has in tables and JSON
/// (docs/command-line.md).
struct NumberColumn {
    std::string_view name;
    /// Empty: the image has no such number.
    std::optional<double> (*value)(const LightNumbers& numbers);
};

/// All of them, in the order of tables.
std::span<const NumberColumn> number_columns();

/// A number as a cell of a CSV: empty for a number that there is not, `inf` for an infinite one.
std::string number_cell(const std::optional<double>& value);

/// The names of all columns, and the values of one row, each after a comma.
std::string number_names_csv();
std::string number_values_csv(const LightNumbers& numbers);

/// Those that matter most, aligned, a line for each part and lamp under a line of names.
std::string numbers_text(std::span<const PartNumbers> rows);

}  // namespace uw
