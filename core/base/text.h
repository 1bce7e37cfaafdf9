#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace uw {

/// User text made fit for a one-line message: control characters become '?', and what is longer
/// than `max_bytes` is cut at a UTF-8 boundary and ends in "...".
std::string printable(std::string_view text, std::size_t max_bytes = 60);

/// The candidate that `text` is most likely a slip of (optimal string alignment distance, letter
/// case ignored, or a beginning of it); empty if none is near.
std::string_view nearest_word(std::string_view text, std::span<const std::string_view> candidates);

/// "did you mean 'x'?" where a candidate is near, else "use one of: a, b, c".
std::string suggestion(std::string_view text, std::span<const std::string_view> candidates);

/// The words as "a, b or c".
std::string alternatives(std::span<const std::string_view> words);

/// The words of a table of words and what they mean.
template <class T, std::size_t N>
constexpr std::array<std::string_view, N> words_of(
    const std::array<std::pair<std::string_view, T>, N>& table) {
    std::array<std::string_view, N> words;
    for (std::size_t i = 0; i < N; ++i) words[i] = table[i].first;
    return words;
}

/// Outcome of parse_number.
enum class NumberText : std::uint8_t { number, not_finite, out_of_range, no_number };

/// Reads `text` as a decimal number, all of it and regardless of the locale.
NumberText parse_number(std::string_view text, double& value);

}  // namespace uw
