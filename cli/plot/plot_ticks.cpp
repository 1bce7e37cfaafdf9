#include "cli/plot/plot_ticks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace uw {

namespace {

constexpr double k_linear_intervals = 7;  // at most, between labelled ticks
constexpr int k_log_labels = 8;           // at most, at powers of ten
constexpr int k_minor_decades = 12;       // with more, minor ticks would merge
// Axes extend no further: room for every meaningful double without overflow.
constexpr double k_largest = 1e200;

/// 10^n as "10⁻³"; superscripts are characters, as SVG programs differ on baseline-shift.
std::string power_of_ten(int exponent) {
    static constexpr const char* k_digits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    std::string text = exponent < 0 ? "10⁻" : "10";
    for (const char digit : fmt::format("{}", std::abs(exponent))) text += k_digits[digit - '0'];
    return text;
}

/// The multiple of 1, 2 or 5 times a power of ten that is not less than `x` > 0.
double round_step(double x) {
    const double power = std::pow(10, std::floor(std::log10(x)));
    for (const double factor : {1.0, 2.0, 5.0})
        if (factor * power >= x * (1 - 1e-9)) return factor * power;
    return 10 * power;
}

std::string linear_label(double value, double step) {
    if (std::abs(value) < 1e-9 * step) return "0";
    if (std::abs(value) >= 1e5 || step < 1e-4) return fmt::format("{:.6g}", value);
    int decimals = 0;
    for (double scaled = step; decimals < 6; ++decimals, scaled *= 10)
        if (std::abs(scaled - std::round(scaled)) < 1e-6 * scaled) break;
    return fmt::format("{:.{}f}", value, decimals);
}

AxisTicks linear_ticks(const AxisRequest& request, double low, double high) {
    AxisTicks axis{request.min.value_or(low), request.max.value_or(high), {}};
    if (!(axis.max > axis.min)) {
        const double pad = std::max(1e-12, 0.5 * std::abs(axis.min));
        if (!request.min) axis.min -= pad;
        axis.max = axis.min + 2 * pad;
    }
    const double length = axis.max - axis.min;
    double step = round_step(length / k_linear_intervals);
    if (request.tick_step && length / *request.tick_step < 100) step = *request.tick_step;
    if (!request.min) axis.min = step * std::floor(axis.min / step + 1e-9);
    if (!request.max) axis.max = step * std::ceil(axis.max / step - 1e-9);
    const double first = std::ceil(axis.min / step - 1e-9);
    const double last = std::floor(axis.max / step + 1e-9);
    for (double i = first; i <= last; ++i)
        axis.ticks.push_back(
            {std::clamp(i * step, axis.min, axis.max), linear_label(i * step, step)});
    return axis;
}

AxisTicks log_ticks(const AxisRequest& request, double low, double high) {
    AxisTicks axis{request.min.value_or(low), request.max.value_or(high), {}};
    if (!(axis.max >= axis.min)) axis.max = axis.min;
    if (!request.min) axis.min = std::pow(10, std::floor(std::log10(axis.min) + 1e-9));
    if (!request.max) axis.max = std::pow(10, std::ceil(std::log10(axis.max) - 1e-9));
    if (!(axis.max > axis.min)) axis.max = 10 * axis.min;
    const int first = static_cast<int>(std::floor(std::log10(axis.min) + 1e-9));
    const int last = static_cast<int>(std::ceil(std::log10(axis.max) - 1e-9));
    const int decades = last - first;
    const int labelled = (decades + k_log_labels - 1) / k_log_labels;  // decades per label
    const bool plain = first >= -2 && last <= 3;
    const bool short_axis = decades <= 2;  // then powers of ten alone are too few labels
    const auto inside = [&](double value) {
        return value >= axis.min * (1 - 1e-9) && value <= axis.max * (1 + 1e-9);
    };
    for (int n = first; n <= last; ++n)
        for (int factor = 1; factor <= 9; ++factor) {
            const double value = factor * std::pow(10, n);
            if (!inside(value) || (factor > 1 && decades > k_minor_decades)) continue;
            std::string label;
            if (factor == 1 && (n - first) % labelled == 0)
                label = plain ? fmt::format("{:g}", value) : power_of_ten(n);
            else if (short_axis && (factor == 2 || factor == 5))
                label = plain ? fmt::format("{:g}", value)
                              : fmt::format("{}·{}", factor, power_of_ten(n));
            axis.ticks.push_back({std::clamp(value, axis.min, axis.max), label});
        }
    return axis;
}

}  // namespace

AxisTicks choose_ticks(const AxisRequest& request, std::span<const double> values) {
    const bool log = request.scale == AxisScale::log;
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const double value : values) {
        if (!(std::abs(value) < k_largest) || (log && !(value > 1 / k_largest))) continue;
        low = std::min(low, value);
        high = std::max(high, value);
    }
    if (!(low <= high)) {
        low = log ? 1 : 0;
        high = log ? 10 : 1;
    }
    return log ? log_ticks(request, low, high) : linear_ticks(request, low, high);
}

}  // namespace uw
