#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/json.h"

namespace uw {

/// The results of a command, built once and printed as text for people or as JSON for programs: a
/// tree of reports. A report holds values under keys, which only JSON shows, lines, which only text
/// shows, and further reports, which both show, all in the order in which they were added.
class Report {
  public:
    /// `heading`: a line of text above all others, which are indented below; empty: there is none,
    /// and they stand where it would.
    explicit Report(std::string_view heading = {});

    /// The values of an object: {{"width", 3}, {"height", 2}}.
    void set(const Json& values) { json_.update(values); }
    /// Text of one line or several, with or without a newline at the end.
    void say(std::string_view text);
    /// A report that is an object in JSON.
    void add(const std::string& key, const Report& part);
    /// Reports that are a list of objects in JSON; `heading` as above.
    void add(const std::string& key, const std::vector<Report>& parts,
             std::string_view heading = {});

    const std::string& text() const { return text_; }
    /// Indented, as json_text.
    std::string json() const { return json_text(json_); }
    std::string printed(bool as_json) const { return as_json ? json() : text(); }

  private:
    std::size_t indent_;  // of lines in `text_`
    std::string text_;
    Json json_ = Json::object();
};

/// The rows of a table as lines. Columns are as wide as their widest cell, at least `narrowest`
/// characters, and begin two blanks apart; all cells but those of the first `left` columns are
/// aligned to the right. Precondition: all rows have as many cells.
std::vector<std::string> aligned_rows(const std::vector<std::vector<std::string>>& rows,
                                      std::size_t left, std::size_t narrowest = 0);

}  // namespace uw
