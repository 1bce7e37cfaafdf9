#include "core/base/text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <system_error>
#include <vector>

namespace uw {

namespace {

constexpr std::size_t k_longest_word = 64;

char lower(char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

/// Number of insertions, deletions, substitutions and transpositions of neighbours that turn `a`
/// into `b`.
std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
    for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
    for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const bool same = lower(a[i - 1]) == lower(b[j - 1]);
            d[i][j] =
                std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (same ? 0 : 1)});
            if (i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) &&
                lower(a[i - 2]) == lower(b[j - 1])) {
                d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
            }
        }
    }
    return d[a.size()][b.size()];
}

}  // namespace

std::string_view trimmed(std::string_view text, std::string_view blanks) {
    const std::size_t first = text.find_first_not_of(blanks);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::string_view take_line(std::string_view& text) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    return line;
}

bool take_beginning(std::string_view& text, std::string_view beginning) {
    if (!text.starts_with(beginning)) return false;
    text.remove_prefix(beginning.size());
    return true;
}

std::vector<std::string_view> split(std::string_view text, char separator) {
    std::vector<std::string_view> parts;
    for (std::size_t start = 0; start <= text.size();) {
        const std::size_t end = std::min(text.find(separator, start), text.size());
        parts.push_back(text.substr(start, end - start));
        start = end + 1;
    }
    return parts;
}

std::string lower_case(std::string_view text) {
    std::string small(text);
    std::ranges::transform(small, small.begin(), lower);
    return small;
}

bool same_ignoring_case(std::string_view a, std::string_view b) {
    return std::ranges::equal(a, b, {}, lower, lower);
}

std::string printable(std::string_view text, std::size_t max_bytes) {
    std::size_t end = std::min(text.size(), max_bytes);
    const bool cut = end < text.size();
    // never cut inside a multi-byte character
    while (cut && end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;
    std::string line(text.substr(0, end));
    for (char& c : line) {
        if (static_cast<unsigned char>(c) < 0x20U || c == 0x7F) c = '?';
    }
    return cut ? line + "..." : line;
}

std::string_view nearest_word(std::string_view text, std::span<const std::string_view> candidates) {
    if (text.size() > k_longest_word) return {};
    std::string_view best;
    std::size_t best_distance = 2 + text.size() / 4;  // one error per four letters, plus one
    for (const std::string_view candidate : candidates) {
        // "fov" matches "fov_x", however much is missing
        const bool shortened = text.size() > 1 && candidate.starts_with(text);
        const std::size_t distance = shortened ? 1 : edit_distance(text, candidate);
        if (distance < best_distance && distance < std::max(text.size(), candidate.size())) {
            best = candidate;
            best_distance = distance;
        }
    }
    return best;
}

std::string suggestion(std::string_view text, std::span<const std::string_view> candidates) {
    const std::string_view near = nearest_word(text, candidates);
    if (!near.empty()) return "did you mean '" + std::string(near) + "'?";
    std::string list = "use one of: ";
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        if (i > 0) list += ", ";
        list += candidates[i];
    }
    return list;
}

std::string alternatives(std::span<const std::string_view> words) {
    std::string list;
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (i > 0) list += i + 1 < words.size() ? ", " : " or ";
        list += words[i];
    }
    return list;
}

std::string counted(std::size_t number, std::string_view thing) {
    std::string text = std::to_string(number) + " ";
    text += thing;
    if (number != 1) text += 's';
    return text;
}

NumberText parse_number(std::string_view text, double& value) {
    const bool plus = text.starts_with('+');
    if (plus) text.remove_prefix(1);
    if (text.empty() || (plus && text.starts_with('-'))) return NumberText::no_number;
    const std::string_view bare = text.starts_with('-') ? text.substr(1) : text;
    if (bare == ".inf" || bare == ".Inf" || bare == ".INF" || bare == ".nan" || bare == ".NaN" ||
        bare == ".NAN") {
        return NumberText::not_finite;
    }
    double parsed = 0;
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, parsed);
    if (error == std::errc::invalid_argument || stop != end) return NumberText::no_number;
    if (error == std::errc::result_out_of_range) return NumberText::out_of_range;
    if (!std::isfinite(parsed)) return NumberText::not_finite;
    value = parsed == 0.0 ? 0.0 : parsed;  // -0 means 0
    return NumberText::number;
}

namespace {

std::uint8_t byte_at(std::string_view bytes, std::size_t i) {
    return static_cast<std::uint8_t>(bytes[i]);
}

/// Length of the character that starts at `i`; 0 if none does (RFC 3629, section 4).
std::size_t character_length(std::string_view bytes, std::size_t i) {
    const std::uint8_t first = byte_at(bytes, i);
    if (first < 0x80) {
        const bool text =
            first >= 0x20 ? first != 0x7F : first == '\t' || first == '\n' || first == '\r';
        return text ? 1 : 0;
    }
    const std::size_t length = first >= 0xF0 ? 4 : (first >= 0xE0 ? 3 : 2);
    if (first < 0xC2 || first > 0xF4 || i + length > bytes.size()) return 0;
    for (std::size_t k = 1; k < length; ++k) {
        if ((byte_at(bytes, i + k) & 0xC0U) != 0x80U) return 0;
    }
    const std::uint8_t second = byte_at(bytes, i + 1);
    const bool overlong = (first == 0xE0 && second < 0xA0) || (first == 0xF0 && second < 0x90);
    const bool outside = (first == 0xED && second > 0x9F) || (first == 0xF4 && second > 0x8F);
    return overlong || outside ? 0 : length;
}

}  // namespace

std::size_t first_non_text(std::string_view bytes) {
    std::size_t i = 0;
    while (i < bytes.size()) {
        const std::size_t length = character_length(bytes, i);
        if (length == 0) return i;
        i += length;
    }
    return i;
}

}  // namespace uw
