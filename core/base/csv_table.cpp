#include "core/base/csv_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include "core/base/error.h"
#include "core/base/input_files.h"
#include "core/base/text.h"

namespace uw {

double SampledCurve::value(double at) const {
    const auto above = std::upper_bound(x.begin(), x.end(), at);
    if (above == x.begin()) return y.front();
    if (above == x.end()) return y.back();
    const auto i = static_cast<std::size_t>(above - x.begin()) - 1;
    const double t = (at - x[i]) / (x[i + 1] - x[i]);
    return y[i] + t * (y[i + 1] - y[i]);
}

void skip_byte_order_mark(std::string_view& text) {
    constexpr std::string_view k_byte_order_mark = "\xEF\xBB\xBF";
    if (text.starts_with(k_byte_order_mark)) text.remove_prefix(k_byte_order_mark.size());
}

std::vector<std::string_view> csv_cells(std::string_view line) {
    std::vector<std::string_view> cells;
    for (;;) {
        const std::size_t comma = line.find(',');
        cells.push_back(trimmed(line.substr(0, comma)));
        if (comma == std::string_view::npos) return cells;
        line.remove_prefix(comma + 1);
    }
}

std::string quoted_cell(std::string_view text) {
    constexpr std::size_t k_longest = 40;
    std::string shown = "'";
    for (const char c : text.substr(0, k_longest)) shown += (c >= ' ' && c <= '~') ? c : '?';
    return shown + (text.size() > k_longest ? "...'" : "'");
}

std::string csv_text(std::string_view text) {
    if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
    std::string quoted = "\"";
    for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    return quoted + "\"";
}

CsvTable::CsvTable(std::string_view text, std::string name) : name_(std::move(name)) {
    const auto split = [](std::string_view line) {
        const std::vector<std::string_view> cells = csv_cells(line);
        return std::vector<std::string>(cells.begin(), cells.end());
    };
    skip_byte_order_mark(text);
    int line_number = 0;
    while (!text.empty()) {
        const std::string_view line = trimmed(take_line(text));
        ++line_number;
        if (line.empty() || line.front() == '#') continue;
        if (std::count(line.begin(), line.end(), ',') >= static_cast<std::ptrdiff_t>(k_max_columns))
            throw InputError(
                fmt::format("{}:{}: more than {} columns; give a table of a few columns", name_,
                            line_number, k_max_columns));
        if (columns_.empty()) {
            columns_ = split(line);
            continue;
        }
        if (rows_.size() == k_max_rows)
            throw InputError(fmt::format("{}:{}: more than {} rows; thin out the table", name_,
                                         line_number, k_max_rows));
        rows_.push_back({line_number, split(line)});
        if (rows_.back().cells.size() != columns_.size())
            throw InputError(
                fmt::format("{}:{}: {} cells where the header names {} columns; give "
                            "one cell per column",
                            name_, line_number, rows_.back().cells.size(), columns_.size()));
    }
    if (rows_.empty())
        throw InputError(
            fmt::format("{}: no rows; a table is a line of comma-separated column "
                        "names and lines of values",
                        name_));
}

std::size_t CsvTable::column_index(std::string_view column) const {
    for (std::size_t i = 0; i < columns_.size(); ++i)
        if (columns_[i] == column) return i;
    std::string present;
    for (const std::string& name : columns_)
        if (present.size() < 200) present += (present.empty() ? "" : ", ") + quoted_cell(name);
    throw InputError(
        fmt::format("{}: no column '{}'; the header names {}", name_, column, present));
}

double CsvTable::number(const Row& row, std::size_t column) const {
    const std::string& cell = row.cells[column];
    double value = 0;
    const char* const end = cell.data() + cell.size();
    const auto [stop, error] = std::from_chars(cell.data(), end, value);
    if (error != std::errc() || stop != end || !std::isfinite(value))
        throw InputError(
            fmt::format("{}:{}: {} in column {} is not a number; write it like 0.25 "
                        "or 1.5e-3",
                        name_, row.line, quoted_cell(cell), quoted_cell(columns_[column])));
    return value;
}

std::vector<std::string> CsvTable::text(std::string_view column) const {
    const std::size_t index = column_index(column);
    std::vector<std::string> cells;
    cells.reserve(rows_.size());
    for (const Row& row : rows_) cells.push_back(row.cells[index]);
    return cells;
}

std::vector<double> CsvTable::numbers(std::string_view column) const {
    const std::size_t index = column_index(column);
    std::vector<double> values;
    values.reserve(rows_.size());
    for (const Row& row : rows_) values.push_back(number(row, index));
    return values;
}

SampledCurve CsvTable::curve(std::string_view x_column, std::string_view y_column) const {
    const std::size_t x_index = column_index(x_column);
    const std::size_t y_index = column_index(y_column);
    SampledCurve result;
    for (const Row& row : rows_) {
        if (row.cells[x_index].empty() || row.cells[y_index].empty()) continue;
        const double x = number(row, x_index);
        if (!result.x.empty() && !(x > result.x.back()))
            throw InputError(
                fmt::format("{}:{}: {} = {} does not ascend; sort the rows and give "
                            "each value once",
                            name_, row.line, quoted_cell(x_column), x));
        result.x.push_back(x);
        result.y.push_back(number(row, y_index));
    }
    if (result.x.empty())
        throw InputError(
            fmt::format("{}: no row has values in both columns '{}' and '{}'; fill them in", name_,
                        x_column, y_column));
    return result;
}

CsvTable CsvTable::where(std::string_view column, std::string_view value) const {
    const std::size_t index = column_index(column);
    CsvTable selected = *this;
    std::erase_if(selected.rows_, [&](const Row& row) { return row.cells[index] != value; });
    return selected;
}

CsvTable read_embedded_table(std::string_view name) {
    for (const EmbeddedTable& table : embedded_tables())
        if (table.name == name) return CsvTable(table.text, std::string(name));
    throw std::logic_error(fmt::format("no table '{}' was compiled in", name));
}

namespace {

constexpr std::size_t k_max_file = std::size_t{4} << 20;

}  // namespace

CsvTable read_csv_file(const std::filesystem::path& file, const std::string& where) {
    const std::string subject = fmt::format("{}: {}", where, printable(file.string(), 300));
    return CsvTable(read_text_file(file, subject, k_max_file, "table"),
                    printable(file.filename().string(), 300));
}

}  // namespace uw
