#include "cli/water/band_list.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include "core/base/error.h"
#include "core/base/text.h"

namespace uw {

namespace {

constexpr int k_most_bands = 2000;

[[noreturn]] void fail(const std::string& text, std::string_view what) {
    throw UsageError(fmt::format("--bands {}: {}", printable(text), what));
}

/// A number within [low, high], or 0.
double parse_number(std::string_view text, double low, double high) {
    double value = 0;
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    return error == std::errc() && stop == end && value >= low && value <= high ? value : 0;
}

double parse_wavelength(std::string_view part, const std::string& text) {
    const double value = parse_number(part, 10, 1e5);
    if (value == 0) fail(text, "give nanometres, as in 620,540,450 or 400:700:10");
    return value;
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

std::vector<double> parse_range(const std::vector<std::string_view>& parts,
                                const std::string& text) {
    const double step = parts.size() == 3 ? parse_number(parts[2], 1e-6, 1e5) : 0;
    if (step == 0) fail(text, "a range is first:last:step in nm, such as 400:700:10");
    const double first = parse_wavelength(parts[0], text);
    const double last = parse_wavelength(parts[1], text);
    const double count = std::floor((last - first) / step + 1e-9) + 1;
    if (count < 1) fail(text, "the last wavelength is less than the first; swap them");
    if (count > k_most_bands)
        fail(text, fmt::format("more than {} wavelengths; give a larger step", k_most_bands));
    std::vector<double> bands;
    bands.reserve(static_cast<std::size_t>(count));
    for (int i = 0; i < static_cast<int>(count); ++i) bands.push_back(first + i * step);
    return bands;
}

}  // namespace

std::vector<double> parse_bands(const std::string& text) {
    const std::vector<std::string_view> range = split(text, ':');
    if (range.size() > 1) return parse_range(range, text);
    std::vector<double> bands;
    for (const std::string_view part : split(text, ','))
        bands.push_back(parse_wavelength(part, text));
    if (bands.size() > static_cast<std::size_t>(k_most_bands))
        fail(text, fmt::format("more than {} wavelengths", k_most_bands));
    std::vector<double> sorted = bands;
    std::sort(sorted.begin(), sorted.end());
    if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end())
        fail(text, "a wavelength is given twice; remove one");
    return bands;
}

}  // namespace uw
