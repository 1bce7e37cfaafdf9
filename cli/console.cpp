#include "cli/console.h"

#include <fcntl.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <fstream>

#include "core/base/error.h"
#include "core/base/json.h"

namespace uw {

void prepare_streams() {
    // open() returns the lowest free number: one after the other, those that were closed.
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        if (::fcntl(stream, F_GETFD) < 0 && ::open("/dev/null", O_RDWR) < 0) return;
    std::signal(SIGXFSZ, SIG_IGN);
}

void print_message(std::string_view text) {
    std::fwrite(text.data(), 1, text.size(), stderr);
    std::fflush(stderr);
}

void print_output(std::string_view text) {
    const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
    if (std::fflush(stdout) != 0 || !written)
        throw IoError("standard output: cannot write; is the disk full?");
}

void TextFiles::add(const std::filesystem::path& path, const std::string& content) {
    files_.push_back({path, std::make_unique<AtomicFile>(path)});
    std::ofstream out(files_.back().file->temporary_path(), std::ios::binary);
    out << content;
    out.close();
    if (!out) throw IoError(fmt::format("{}: cannot write; is the disk full?", path.string()));
}

void TextFiles::commit(bool quiet) {
    for (Entry& entry : files_) {
        entry.file->commit();
        if (!quiet) print_message(fmt::format("wrote {}\n", entry.path.string()));
    }
    files_.clear();
}

void check_outputs(std::initializer_list<std::filesystem::path> outputs) {
    for (const std::filesystem::path& file : outputs)
        if (!file.empty()) const AtomicFile probe(file);
}

void write_text(const std::filesystem::path& output, const std::string& content, bool quiet) {
    if (output.empty()) {
        print_output(content);
        return;
    }
    TextFiles files;
    files.add(output, content);
    files.commit(quiet);
}

namespace {

constexpr double k_short_interval = 0.1;  // seconds between two drawings of the bar, or objects
constexpr double k_line_interval = 5.0;   // seconds between two plain lines
constexpr int k_longest_bar = 30;
constexpr int k_shortest_bar = 5;

// Width of the terminal; 80 if it is unknown.
int terminal_columns() {
    winsize size{};
    const bool known = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
    return known ? size.ws_col : 80;
}

// "0.0523", "1.52", "153": three significant figures.
std::string format_rate(double rate) {
    const double figures = rate > 0 ? 2 - std::floor(std::log10(rate)) : 0;
    return fmt::format("{:.{}f}", rate, static_cast<int>(std::clamp(figures, 0.0, 6.0)));
}

}  // namespace

std::string format_duration(double seconds) {
    if (seconds < 9.95) return fmt::format("{:.1f} s", seconds);
    const auto whole = std::llround(seconds);
    if (whole < 60) return fmt::format("{} s", whole);
    if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
    return fmt::format("{} h {:02} min", whole / 3600, whole % 3600 / 60);
}

Progress::Progress(std::string label, std::string unit, double scale, ProgressForm form,
                   std::optional<double> seconds_left)
    : label_(std::move(label)),
      unit_(std::move(unit)),
      scale_(scale),
      form_(form),
      seconds_left_(seconds_left),
      terminal_(isatty(STDERR_FILENO) != 0),
      start_(std::chrono::steady_clock::now()) {}

Progress::~Progress() {
    end_line();
}

void Progress::end_line() {
    const std::lock_guard lock(mutex_);
    if (drawn_ && is_bar()) print_message("\n");
    drawn_ = false;
    last_length_ = 0;
}

void Progress::update(double fraction, const std::string& note) {
    if (form_ == ProgressForm::none) return;
    const std::lock_guard lock(mutex_);
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start_;
    const bool is_often = is_bar() || form_ == ProgressForm::json;
    const double interval = is_often ? k_short_interval : k_line_interval;
    const bool last = fraction >= 1;
    if (!last && elapsed.count() - last_drawn_ < interval) return;
    if (last && !drawn_) return;  // finished before anything had to be shown
    last_drawn_ = elapsed.count();
    draw(fraction, elapsed.count(), note);
}

void Progress::draw(double fraction, double seconds, const std::string& note) {
    std::optional<double> seconds_left;
    if (seconds_left_)
        seconds_left = std::max(*seconds_left_ - seconds, 0.0);
    else if (fraction > 0)
        seconds_left = seconds * (1 - std::min(fraction, 1.0)) / fraction;
    drawn_ = true;
    if (form_ == ProgressForm::json) {
        print_json(fraction, seconds_left, note);
        return;
    }
    const double rate = seconds > 0 ? fraction * scale_ / seconds : 0;
    std::string time;
    if (fraction >= 1 && !seconds_left_)
        time = format_duration(seconds);
    else if (seconds_left)
        time = format_duration(*seconds_left) + " left";
    std::string figures = fmt::format("{:3.0f} %  ", 100 * fraction);
    if (!note.empty()) figures += note + "  ";
    if (!unit_.empty()) figures += fmt::format("{} {}/s  ", format_rate(rate), unit_);
    figures += time;
    if (terminal_)
        draw_bar(fraction, figures);
    else
        print_message(fmt::format("{} {}\n", label_, figures));
}

void Progress::print_json(double fraction, std::optional<double> seconds_left,
                          const std::string& note) {
    Json line{{"stage", label_}, {"fraction", std::min(fraction, 1.0)}};
    if (seconds_left) line["seconds_left"] = *seconds_left;
    if (!note.empty()) line["note"] = note;
    print_message(json_line(line) + "\n");
}

void Progress::draw_bar(double fraction, const std::string& figures) {
    // A line that fills the last column may wrap, and then could not be overwritten.
    const int room = terminal_columns() - 1;
    const int for_bar = room - static_cast<int>(label_.size() + figures.size()) - 4;
    std::string line = label_ + " ";
    if (for_bar >= k_shortest_bar) {
        const int width = std::min(for_bar, k_longest_bar);
        const auto filled = static_cast<std::size_t>(fraction * width);
        line += "[" + std::string(filled, '=') +
                std::string(static_cast<std::size_t>(width) - filled, ' ') + "] ";
    }
    line += figures;
    line.resize(std::min(line.size(), static_cast<std::size_t>(std::max(room, 1))));
    const std::size_t length = line.size();
    if (length < last_length_) line.append(last_length_ - length, ' ');
    last_length_ = length;
    print_message("\r" + line);
}

}  // namespace uw
