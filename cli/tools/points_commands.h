#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cli/command.h"

namespace uw {

/// A table of comma-separated values, some of whose columns are coordinates; all others are carried
/// along. Lines starting with '#' are comments. The first other line names the columns; without
/// names there are the coordinates alone, in their order. `nan` stands for a point that is unknown.
class CoordinateTable {
  public:
    /// The names of the coordinates' columns: what is read are those of the first set that the
    /// header has. Letters may be of either case.
    using NameSets = std::span<const std::vector<std::string_view>>;

    /// Reads `text`; `name` is what messages call it. All sets have as many names. Throws
    /// InputError that names the line and the column.
    CoordinateTable(std::string text, std::string name, NameSets names);
    CoordinateTable(const CoordinateTable&) = delete;  // its lines refer to its text
    CoordinateTable& operator=(const CoordinateTable&) = delete;
    CoordinateTable(CoordinateTable&&) = delete;
    CoordinateTable& operator=(CoordinateTable&&) = delete;
    ~CoordinateTable() = default;

    std::size_t row_count() const { return lines_.size(); }
    /// The coordinates of a row, as many as names; NaN where unknown.
    std::span<const double> coordinates(std::size_t row) const {
        return std::span(coordinates_).subspan(row * width_, width_);
    }

    /// The table with further columns: their names, and for each row, in parallel, the cells that
    /// `cells_of` appends to its text, each after a comma. Throws InputError if the table has one
    /// of the columns already.
    std::string with_columns(
        const std::vector<std::string_view>& names,
        const std::function<void(std::size_t row, std::string& text)>& cells_of) const;

  private:
    void read_header(std::string_view line, int line_number, NameSets names);
    void read_row(std::string_view line, int line_number);

    std::string text_;
    std::string name_;
    std::size_t width_;                 // number of coordinates
    std::string header_;                // as written, or made
    std::vector<std::string> columns_;  // of the header
    std::vector<std::size_t> chosen_;   // columns of the coordinates
    std::vector<std::string_view> lines_;
    std::vector<double> coordinates_;
};

/// `uwvdb project`: where a scene's camera sees points of the world, as a table on standard output
/// or in a file. Counts go to stderr. Throws UsageError, InputError and IoError.
Command project_command();

/// `uwvdb rays`: the rays in the water of positions in a scene's image, likewise.
Command rays_command();

}  // namespace uw
