#include "cli/points/coordinate_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <optional>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/base/text.h"
#include "core/files/text_file.h"
#include "core/tables/csv_cells.h"

namespace uw {

namespace {

constexpr std::size_t k_rows_per_part = 4096;

bool is_same_word(std::string_view a, std::string_view b) {
    return std::ranges::equal(
        a, b, [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

/// NaN for `nan`; none for what is no number.
std::optional<double> coordinate_in(std::string_view cell) {
    if (is_same_word(cell, "nan")) return std::numeric_limits<double>::quiet_NaN();
    double value = 0;
    if (parse_number(cell, value) != NumberText::number) return std::nullopt;
    return value;
}

bool holds_numbers(const std::vector<std::string_view>& cells) {
    return std::ranges::all_of(
        cells, [](std::string_view cell) { return coordinate_in(cell).has_value(); });
}

std::optional<std::size_t> column_called(std::string_view name,
                                         const std::vector<std::string>& columns) {
    const auto found = std::ranges::find_if(
        columns, [&](const std::string& column) { return is_same_word(column, name); });
    if (found == columns.end()) return std::nullopt;
    return static_cast<std::size_t>(found - columns.begin());
}

}  // namespace

CoordinateTable::CoordinateTable(std::string text, std::string name, NameSets names)
    : text_(std::move(text)), name_(std::move(name)), width_(names.front().size()) {
    std::string_view rest = text_;
    skip_byte_order_mark(rest);
    for (int line_number = 1; !rest.empty(); ++line_number) {
        const std::string_view line = take_csv_line(rest);
        if (line.empty() || line.front() == '#') continue;
        if (!columns_.empty()) {
            read_row(line, line_number);
            continue;
        }
        read_header(line, line_number, names);
        if (holds_numbers(csv_cells(line))) read_row(line, line_number);
    }
    if (lines_.empty())
        throw InputError(
            fmt::format("{}: no rows; give a line that names the columns {}, and a "
                        "line for each point",
                        name_, fmt::join(names.front(), ", ")));
}

void CoordinateTable::read_header(std::string_view line, int line_number, NameSets names) {
    const std::vector<std::string_view> cells = csv_cells(line);
    if (holds_numbers(cells)) {
        if (cells.size() != width_)
            throw InputError(fmt::format(
                "{}:{}: {} without a header; name the columns in a first line, such as "
                "{}, or leave those alone",
                name_, line_number,
                cells.size() == 1 ? "1 number" : fmt::format("{} numbers", cells.size()),
                fmt::join(names.front(), ",")));
        columns_.assign(names.front().begin(), names.front().end());
        header_ = fmt::format("{}", fmt::join(columns_, ","));
        for (std::size_t i = 0; i < width_; ++i) chosen_.push_back(i);
        return;
    }
    columns_.assign(cells.begin(), cells.end());
    header_ = line;
    for (const std::vector<std::string_view>& set : names) {
        chosen_.clear();
        for (const std::string_view column : set)
            if (const auto index = column_called(column, columns_)) chosen_.push_back(*index);
        if (chosen_.size() == width_) return;
    }
    std::string wanted, present;
    for (const std::vector<std::string_view>& set : names)
        wanted += fmt::format("{}{}", wanted.empty() ? "" : ", or ", fmt::join(set, ", "));
    for (const std::string& column : columns_)
        if (present.size() < 200) present += (present.empty() ? "" : ", ") + quoted_cell(column);
    throw InputError(
        fmt::format("{}:{}: the columns {} are needed, separated by commas; the first line names "
                    "{}",
                    name_, line_number, wanted, present));
}

void CoordinateTable::read_row(std::string_view line, int line_number) {
    const std::vector<std::string_view> cells = csv_cells(line);
    if (cells.size() != columns_.size())
        throw InputError(fmt::format(
            "{}:{}: {} where there are {} columns; give one cell per column", name_, line_number,
            cells.size() == 1 ? "1 cell" : fmt::format("{} cells", cells.size()), columns_.size()));
    for (const std::size_t column : chosen_) {
        const std::optional<double> value = coordinate_in(cells[column]);
        if (!value)
            throw InputError(fmt::format(
                "{}:{}: {} in column {} is not a finite number; write it like 0.25 or 1.5e-3, or "
                "nan where there is none",
                name_, line_number, quoted_cell(cells[column]), quoted_cell(columns_[column])));
        coordinates_.push_back(*value);
    }
    lines_.push_back(line);
}

std::string CoordinateTable::with_columns(
    const std::vector<std::string_view>& names,
    const std::function<void(std::size_t row, std::string& text)>& cells_of) const {
    for (const std::string_view name : names)
        if (column_called(name, columns_))
            throw InputError(
                fmt::format("{}: has a column {} already; rename it", name_, quoted_cell(name)));
    std::vector<std::string> parts((lines_.size() + k_rows_per_part - 1) / k_rows_per_part);
    parallel_for(parts.size(), [&](std::size_t part) {
        const std::size_t end = std::min(lines_.size(), (part + 1) * k_rows_per_part);
        for (std::size_t row = part * k_rows_per_part; row < end; ++row) {
            parts[part] += lines_[row];
            cells_of(row, parts[part]);
            parts[part] += '\n';
        }
    });
    std::string table = fmt::format("{},{}\n", header_, fmt::join(names, ","));
    for (const std::string& part : parts) table += part;
    return table;
}

CoordinateTable read_coordinates(const std::filesystem::path& file,
                                 CoordinateTable::NameSets names) {
    constexpr std::size_t k_largest_file = std::size_t{1} << 30;
    const std::string subject = printable(file.string(), 300);
    return {read_text_file(file, subject, k_largest_file, "table"), subject, names};
}

}  // namespace uw
