#include "cli/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

namespace uw {

namespace {

constexpr double k_terminal_interval = 0.1;  // seconds between two drawings of the bar
constexpr double k_line_interval = 5.0;      // seconds between two plain lines
constexpr int k_bar_width = 30;

}  // namespace

std::string format_duration(double seconds) {
    if (seconds < 9.95) return fmt::format("{:.1f} s", seconds);
    const auto whole = static_cast<long long>(seconds + 0.5);
    if (whole < 60) return fmt::format("{} s", whole);
    if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
    return fmt::format("{} h {:02} min", whole / 3600, whole % 3600 / 60);
}

Progress::Progress(std::string label, std::string unit, double scale, bool quiet)
    : label_(std::move(label)),
      unit_(std::move(unit)),
      scale_(scale),
      quiet_(quiet),
      terminal_(isatty(STDERR_FILENO) != 0),
      start_(std::chrono::steady_clock::now()) {}

Progress::~Progress() {
    if (drawn_ && terminal_) std::fputs("\n", stderr);
}

void Progress::update(double fraction) {
    if (quiet_) return;
    const std::lock_guard lock(mutex_);
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start_;
    const double interval = terminal_ ? k_terminal_interval : k_line_interval;
    const bool last = fraction >= 1;
    if (!last && elapsed.count() - last_drawn_ < interval) return;
    if (last && !drawn_ && !terminal_) return;  // it was over before a line was due
    last_drawn_ = elapsed.count();
    draw(fraction, elapsed.count());
}

void Progress::draw(double fraction, double seconds) {
    const double rate = seconds > 0 ? fraction * scale_ / seconds : 0;
    const std::string left =
        fraction > 0 ? format_duration(seconds * (1 - fraction) / fraction) + " left" : "";
    const std::string line = fmt::format("{:3.0f} %  {:.3g} {}/s  {}", 100 * fraction, rate, unit_,
                                         fraction >= 1 ? format_duration(seconds) : left);
    if (terminal_) {
        const int filled = static_cast<int>(fraction * k_bar_width);
        fmt::print(stderr, "\r{} [{}{}] {:<40}", label_,
                   std::string(static_cast<std::size_t>(filled), '='),
                   std::string(static_cast<std::size_t>(k_bar_width - filled), ' '), line);
    } else {
        fmt::print(stderr, "{} {}\n", label_, line);
    }
    std::fflush(stderr);
    drawn_ = true;
}

}  // namespace uw
