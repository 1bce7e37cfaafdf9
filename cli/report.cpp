#include "cli/report.h"

#include <algorithm>
#include <string_view>
#include <utility>

namespace uw {

namespace {

constexpr std::size_t k_step = 2;  // between the indentations of text

/// Appends each line of `text` with `indent` blanks before it, unless it is empty.
void print_lines(std::string_view text, std::size_t indent, std::string& out) {
    if (text.ends_with('\n')) text.remove_suffix(1);
    for (std::size_t start = 0; start <= text.size();) {
        const std::size_t end = std::min(text.find('\n', start), text.size());
        if (end > start) out.append(indent, ' ');
        out.append(text.substr(start, end - start)).append("\n");
        start = end + 1;
    }
}

}  // namespace

Report::Report(std::string_view heading) : indent_(heading.empty() ? 0 : k_step) {
    if (!heading.empty()) print_lines(heading, 0, text_);
}

void Report::say(std::string_view text) {
    print_lines(text, indent_, text_);
}

void Report::add(const std::string& key, const Report& part) {
    if (!part.text_.empty()) say(part.text_);
    json_[key] = part.json_;
}

void Report::add(const std::string& key, const std::vector<Report>& parts,
                 std::string_view heading) {
    Report list(heading);
    Json values = Json::array();
    for (const Report& part : parts) {
        if (!part.text_.empty()) list.say(part.text_);
        values.push_back(part.json_);
    }
    list.json_ = std::move(values);
    add(key, list);
}

std::vector<std::string> aligned_rows(const std::vector<std::vector<std::string>>& rows,
                                      std::size_t left, std::size_t narrowest) {
    std::vector<std::size_t> widths(rows.empty() ? 0 : rows.front().size(), narrowest);
    for (const std::vector<std::string>& row : rows)
        for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
    std::vector<std::string> lines;
    for (const std::vector<std::string>& row : rows) {
        std::string& line = lines.emplace_back();
        for (std::size_t i = 0; i < row.size(); ++i) {
            const std::string blanks(widths[i] - row[i].size(), ' ');
            line += (i == 0 ? "" : "  ") + (i < left ? row[i] + blanks : blanks + row[i]);
        }
    }
    return lines;
}

}  // namespace uw
