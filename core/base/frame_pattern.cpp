#include "core/base/frame_pattern.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <iterator>
#include <optional>
#include <set>
#include <system_error>

namespace uw {
namespace {

struct Place {
    std::size_t length = 0;  // of the pattern
    int digits = 0;          // at least
};

bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

// Removes "0N", N of one or two digits, from the beginning of `text`.
std::optional<int> take_width(std::string_view& text) {
    if (!text.starts_with('0')) return std::nullopt;
    int width = 0;
    std::size_t length = 1;
    while (length < std::min<std::size_t>(text.size(), 3) && is_digit(text[length]))
        width = 10 * width + (text[length++] - '0');
    if (length == 1) return std::nullopt;
    text.remove_prefix(length);
    return width;
}

bool take(std::string_view& text, std::string_view beginning) {
    if (!text.starts_with(beginning)) return false;
    text.remove_prefix(beginning.size());
    return true;
}

// The pattern with which `text` begins.
std::optional<Place> place_at(std::string_view text) {
    std::string_view rest = text;
    const auto place = [&](int digits) { return Place{text.size() - rest.size(), digits}; };
    if (take(rest, "#")) {
        while (take(rest, "#")) {
        }
        return place(static_cast<int>(text.size() - rest.size()));
    }
    if (take(rest, "%")) {
        const int digits = take_width(rest).value_or(0);
        if (take(rest, "d")) return place(digits);
        return std::nullopt;
    }
    if (take(rest, "$F")) {
        int digits = 0;
        if (!rest.empty() && is_digit(rest.front()) && rest.front() != '0') {
            digits = rest.front() - '0';
            rest.remove_prefix(1);
        }
        const bool goes_on =
            !rest.empty() && std::isalnum(static_cast<unsigned char>(rest.front())) != 0;
        if (goes_on) return std::nullopt;
        return place(digits);
    }
    if (take(rest, "{frame")) {
        int digits = 0;
        if (take(rest, ":")) {
            digits = take_width(rest).value_or(0);
            take(rest, "d");
        }
        if (take(rest, "}")) return place(digits);
    }
    return std::nullopt;
}

}  // namespace

bool has_frame_pattern(std::string_view name) {
    for (; !name.empty(); name.remove_prefix(1))
        if (place_at(name)) return true;
    return false;
}

std::string expand_frame_pattern(std::string_view name, int frame) {
    std::string result;
    while (!name.empty()) {
        if (const auto place = place_at(name)) {
            result += fmt::format("{:0{}d}", frame, std::max(place->digits, 1));
            name.remove_prefix(place->length);
        } else {
            result += name.front();
            name.remove_prefix(1);
        }
    }
    return result;
}

std::filesystem::path file_of_frame(const std::filesystem::path& name, int frame) {
    std::filesystem::path file;
    for (auto part = name.begin(); part != name.end(); ++part) {
        std::error_code ignored;
        const bool is_last = std::next(part) == name.end();
        if (!is_last && std::filesystem::is_directory(file / *part, ignored))
            file /= *part;
        else
            file /= expand_frame_pattern(part->string(), frame);
    }
    return file;
}

std::vector<int> frames_found(const std::filesystem::path& name) {
    const std::filesystem::path folder = name.parent_path().empty() ? "." : name.parent_path();
    const std::string pattern = name.filename().string();
    std::set<int> frames;
    std::error_code error;
    std::filesystem::directory_iterator entry(folder, error);
    for (; !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
        const std::string file = entry->path().filename().string();
        // Any run of digits may be the number; the right one reproduces the name.
        for (std::size_t at = 0; at < file.size(); ++at) {
            if (!is_digit(file[at]) || (at > 0 && is_digit(file[at - 1]))) continue;
            int number = 0;
            const char* const end = file.data() + file.size();
            if (std::from_chars(file.data() + at, end, number).ec != std::errc()) continue;
            if (expand_frame_pattern(pattern, number) == file) frames.insert(number);
        }
    }
    return {frames.begin(), frames.end()};
}

bool differs_by_frame(const std::filesystem::path& name) {
    return file_of_frame(name, 0) != file_of_frame(name, 1);
}

}  // namespace uw
