#pragma once

#include <string>
#include <string_view>

namespace uw {

/// A line of a text format whose words are separated by spaces and tabs. Refers to its text.
class TextLine {
  public:
    explicit TextLine(std::string_view text) : left_(text) { trim(); }

    bool is_at_end() const { return left_.empty(); }
    /// The next word, empty at the end.
    std::string_view next() const { return left_.substr(0, left_.find_first_of(k_space)); }
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
    static constexpr std::string_view k_space = " \t\r\n\v\f";

    void trim() {
        const auto begin = left_.find_first_not_of(k_space);
        left_ = begin == std::string_view::npos
                    ? std::string_view()
                    : left_.substr(begin, left_.find_last_not_of(k_space) - begin + 1);
    }

    std::string_view left_;
};

}  // namespace uw
