#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace uw {

/// `text` without the blanks at its ends.
std::string_view trimmed(std::string_view text, std::string_view blanks = " \t\r");

/// Takes the next line from the beginning of `text`, and the line feed that ends it.
std::string_view take_line(std::string_view& text);

/// Takes `beginning` from the beginning of `text`; returns whether it stood there.
bool take_beginning(std::string_view& text, std::string_view beginning);

/// The parts of `text` between separators: one more than it has separators, each perhaps empty.
std::vector<std::string_view> split(std::string_view text, char separator);

/// Whether it is one of 0 to 9.
constexpr bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

/// `text` with the capitals A to Z as small letters; other bytes stay, whatever the locale.
std::string lower_case(std::string_view text);

/// Whether the texts are the same but for capitals (lower_case).
bool same_ignoring_case(std::string_view a, std::string_view b);

/// User text made suitable for a one-line message: control characters become '?', and text longer
/// than `max_bytes` is truncated at a UTF-8 boundary and ends in "...".
std::string printable(std::string_view text, std::size_t max_bytes = 60);

/// The candidate of which `text` is most likely a misspelling (by optimal string alignment
/// distance, ignoring case) or a prefix; empty if none is close.
std::string_view nearest_word(std::string_view text, std::span<const std::string_view> candidates);

/// "did you mean 'x'?" if a candidate is close, else "use one of: a, b, c".
std::string suggestion(std::string_view text, std::span<const std::string_view> candidates);

/// The words as "a, b or c".
std::string alternatives(std::span<const std::string_view> words);

/// A number of things in words: "1 frame", "3 frames".
std::string counted(std::size_t number, std::string_view thing);

/// The words of a table that maps words to values.
template <class T, std::size_t N>
constexpr std::array<std::string_view, N> words_of(
    const std::array<std::pair<std::string_view, T>, N>& table) {
    std::array<std::string_view, N> words;
    for (std::size_t i = 0; i < N; ++i) words[i] = table[i].first;
    return words;
}

/// The word for `value` in a table of those that scenes and options accept, which has it.
template <class T, std::size_t N>
std::string word_of(T value, const std::array<std::pair<std::string_view, T>, N>& table) {
    return std::string(
        std::ranges::find(table, value, &std::pair<std::string_view, T>::second)->first);
}

/// Outcome of parse_number.
enum class NumberText : std::uint8_t { number, not_finite, out_of_range, no_number };

/// Parses all of `text` as a decimal number, regardless of the locale.
NumberText parse_number(std::string_view text, double& value);

/// The offset of the first byte that is not part of UTF-8 text (RFC 3629), or is a control
/// character other than tab, line feed and carriage return; the size of `bytes` if there is none.
std::size_t first_non_text(std::string_view bytes);

}  // namespace uw
