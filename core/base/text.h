#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace uw {

/// User text made fit for a one-line message: control characters become '?', and what is longer
/// than `max_bytes` is cut at a UTF-8 boundary and ends in "...".
std::string printable(std::string_view text, std::size_t max_bytes = 60);

/// The candidate that `text` is most likely a slip of (optimal string alignment distance, letter
/// case ignored, or a beginning of it); empty if none is near.
std::string_view nearest_word(std::string_view text, std::span<const std::string_view> candidates);

/// "did you mean 'x'?" where a candidate is near, else "use one of: a, b, c".
std::string suggestion(std::string_view text, std::span<const std::string_view> candidates);

/// Outcome of parse_number.
enum class NumberText : std::uint8_t { number, not_finite, out_of_range, no_number };

/// Reads `text` as a decimal number, all of it and regardless of the locale.
NumberText parse_number(std::string_view text, double& value);

}  // namespace uw
