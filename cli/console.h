#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/output_files.h"

namespace uw {

/// To be called first: opens those of stdin, stdout and stderr that the caller has closed, as
/// otherwise the first files opened would take their place and receive our messages; and makes an
/// exceeded file size limit a failed write instead of the end of the program.
void prepare_streams();

/// Writes to stderr. Failure is ignored: it is no reason to end an hour's work.
void print_message(std::string_view text);

/// Writes to stdout and flushes it. Throws IoError.
void print_output(std::string_view text);

/// Text files that are created together or, if one cannot be written, not at all.
class TextFiles {
  public:
    /// Writes `content` beside `path`. Throws IoError.
    void add(const std::filesystem::path& path, const std::string& content);
    /// Gives the files their names, and prints which were written unless `quiet`. Throws IoError.
    void commit(bool quiet = false);

  private:
    struct Entry {
        std::filesystem::path path;
        std::unique_ptr<AtomicFile> file;
    };
    std::vector<Entry> files_;
};

/// Rejects outputs that cannot be written, or that would replace a file that has been read: to be
/// called after the inputs are known and before the work. Empty names are ignored. Throws IoError.
void check_outputs(std::initializer_list<std::filesystem::path> outputs);

/// Writes `content` to the file of option -o, or to standard output if its name is empty. Throws
/// IoError.
void write_text(const std::filesystem::path& output, const std::string& content,
                bool quiet = false);

/// How progress is shown on stderr.
enum class ProgressForm : std::uint8_t {
    none,
    text,  // on a terminal a bar as wide as there is room, otherwise plain lines every few seconds
    json   // a line with an object ten times a second, for programs: docs/command-line.md
};

/// Progress of long work on stderr, with rate and time left. Short work shows nothing. Thread-safe.
class Progress {
  public:
    /// `unit` names what is counted, e.g. "Mpx"; `scale` units make up the whole. Without a unit,
    /// no rate is shown. For work that is
    /// part of more, `seconds_left` is the time that all of it takes from now on; it is shown
    /// instead of this part's.
    Progress(std::string label, std::string unit, double scale, ProgressForm form,
             std::optional<double> seconds_left = {});
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;
    Progress(Progress&&) = delete;
    Progress& operator=(Progress&&) = delete;

    /// Reports that `fraction` (0..1) of the work is done; `note`, if any, is shown beside it.
    void update(double fraction, const std::string& note = {});

    /// To be called before anything else is printed: ends the bar's line. The next update draws it
    /// anew.
    void end_line();

  private:
    void draw(double fraction, double seconds, const std::string& note);
    void draw_bar(double fraction, const std::string& figures);
    void print_json(double fraction, std::optional<double> seconds_left, const std::string& note);
    bool is_bar() const { return form_ == ProgressForm::text && terminal_; }

    std::string label_;
    std::string unit_;
    double scale_;
    ProgressForm form_;
    std::optional<double> seconds_left_;
    bool terminal_;
    bool drawn_ = false;
    std::mutex mutex_;
    std::chrono::steady_clock::time_point start_;
    double last_drawn_ = 0;        // seconds since start
    std::size_t last_length_ = 0;  // of the bar's line
};

/// Seconds as "0.8 s", "12 s", "3 min 05 s", "1 h 12 min".
std::string format_duration(double seconds);

}  // namespace uw
