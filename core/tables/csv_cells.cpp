#include "core/tables/csv_cells.h"

namespace uw {

namespace {

std::string_view trimmed(std::string_view text) {
    constexpr std::string_view k_blank = " \t\r";
    const std::size_t first = text.find_first_not_of(k_blank);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(k_blank) - first + 1);
}

}  // namespace

std::string_view take_csv_line(std::string_view& text) {
    const std::size_t end = text.find('\n');
    const std::string_view line = trimmed(text.substr(0, end));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    return line;
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

}  // namespace uw
