#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace uw {

/// A quantity sampled at ascending positions, linear in between.
struct SampledCurve {
    std::vector<double> x;  // strictly ascending, at least one
    std::vector<double> y;  // same length

    double first() const { return x.front(); }
    double last() const { return x.back(); }
    bool covers(double at) const { return at >= first() && at <= last(); }

    /// Linear interpolation; outside the samples it is constant; callers for whom that is wrong
    /// must check `covers` first.
    double value(double at) const;
};

/// One CSV of assets/spectra, compiled in. Line 1 of `text` is a comment with units and source.
struct EmbeddedTable {
    std::string_view name;
    std::string_view text;
};

/// All tables compiled into the program, in the order of their file names.
const std::vector<EmbeddedTable>& embedded_tables();

/// Functions that read lines of comma-separated values.

/// Removes the byte order mark that `text` may begin with.
void skip_byte_order_mark(std::string_view& text);

/// The cells of a line, without blanks around them; quoting is not supported.
std::vector<std::string_view> csv_cells(std::string_view line);

/// A quotation from a user's table for messages: short and printable, so that it stays one line.
std::string quoted_cell(std::string_view text);

/// A text as a cell of a line: in quotes where it needs them.
std::string csv_text(std::string_view text);

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

/// Reads a CSV file of at most 4 MiB; `where` is the scene entry that names it. Throws InputError
/// if the file is not a valid table, IoError if it cannot be read.
CsvTable read_csv_file(const std::filesystem::path& file, const std::string& where);

}  // namespace uw
