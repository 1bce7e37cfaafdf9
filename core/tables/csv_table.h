#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/tables/sampled_curve.h"

namespace uw {

/// A table of comma-separated values: lines starting with '#' are comments, the first other line
/// names the columns, each further line is a row with the same number of cells. Cells are trimmed
/// and may be blank; quoting is not supported. Numbers use a decimal point whatever the locale.
///
/// Errors are InputError and name the table, the line and the column.
class CsvTable {
  public:
    /// Maximum number of rows; a file with more is not a spectrum or phase function.
    static constexpr std::size_t k_max_rows = 20000;
    /// Maximum number of columns, for the same reason.
    static constexpr std::size_t k_max_columns = 256;

    /// Reads `text`; `name` is what messages call the table (a file name).
    CsvTable(std::string_view text, std::string name);

    const std::string& name() const { return name_; }
    std::size_t row_count() const { return rows_.size(); }
    /// The column names, in order.
    const std::vector<std::string>& columns() const { return columns_; }

    /// The cells of column `column` as text.
    std::vector<std::string> text(std::string_view column) const;

    /// The cells of column `column` as finite numbers; a blank or anything else is an error.
    std::vector<double> numbers(std::string_view column) const;

    /// Column `y_column` as a function of column `x_column`, omitting rows where either is blank. x
    /// must be strictly ascending, and at least one row must remain.
    SampledCurve curve(std::string_view x_column, std::string_view y_column) const;

    /// The rows whose cell in `column` equals `value`, as a table with the same columns.
    CsvTable where(std::string_view column, std::string_view value) const;

  private:
    struct Row {
        int line;
        std::vector<std::string> cells;
    };

    std::size_t column_index(std::string_view column) const;
    double number(const Row& row, std::size_t column) const;

    std::string name_;
    std::vector<std::string> columns_;
    std::vector<Row> rows_;
};

/// The table compiled in from assets/spectra under the file name `name`. An unknown name is a bug
/// in the program: std::logic_error.
CsvTable read_embedded_table(std::string_view name);

}  // namespace uw
