#pragma once

#include <algorithm>
#include <string>
#include <string_view>

namespace uw {

/// A line of a text format whose words are separated by spaces and tabs. Refers to its text.
class TextLine {
  public:
    explicit TextLine(std::string_view text) : left_(text) { trim(); }

    bool is_at_end() const { return left_.empty(); }
    /// The next word, empty at the end.
    std::string_view next() const {
        return {left_.begin(), std::find_if(left_.begin(), left_.end(), is_space)};
    }
    /// The same, which is then taken off the line.
    std::string_view word() {
        const std::string_view taken = next();
        left_.remove_prefix(taken.size());
        trim();
        return taken;
    }
    /// All that is left, without space around it.
    std::string rest() const { return std::string(left_); }

  private:
    static bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

    void trim() {
        while (!left_.empty() && is_space(left_.front())) left_.remove_prefix(1);
        while (!left_.empty() && is_space(left_.back())) left_.remove_suffix(1);
    }

    std::string_view left_;
};

}  // namespace uw
