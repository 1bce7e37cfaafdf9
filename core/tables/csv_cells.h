#pragma once

#include <string>
#include <string_view>
#include <vector>

/// How lines of comma-separated values are read, whatever is made of them.
namespace uw {

/// Takes the next line, without blanks at its ends, from the beginning of `text`.
std::string_view take_csv_line(std::string_view& text);

/// Removes the byte order mark that `text` may begin with.
void skip_byte_order_mark(std::string_view& text);

/// The cells of a line, without blanks around them; quoting is not supported.
std::vector<std::string_view> csv_cells(std::string_view line);

/// What a message may quote of a user's table: short and printable, so that it stays one line.
std::string quoted_cell(std::string_view text);

/// A text as a cell of a line: in quotes where it needs them.
std::string csv_text(std::string_view text);

}  // namespace uw
