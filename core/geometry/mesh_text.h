#pragma once

#include <algorithm>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/text.h"

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

/// A coordinate as text formats write it: NaN if it is not finite or too large, so that what has it
/// is dropped and counted; 0 if it is too small. None if `word` is no number.
inline std::optional<float> mesh_number(std::string_view word) {
    double value = 0;
    switch (parse_number(word, value)) {
        case NumberText::number:
            return static_cast<float>(value);
        case NumberText::not_finite:
            return std::numeric_limits<float>::quiet_NaN();
        case NumberText::out_of_range:
            return word.find("e-") != std::string_view::npos ||
                           word.find("E-") != std::string_view::npos
                       ? 0.0F
                       : std::numeric_limits<float>::quiet_NaN();
        case NumberText::no_number:
            break;
    }
    return std::nullopt;
}

}  // namespace uw
