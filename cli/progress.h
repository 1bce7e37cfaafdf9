#pragma once

#include <chrono>
#include <cstddef>
#include <mutex>
#include <optional>
#include <string>

namespace uw {

/// Progress of long work on stderr: on a terminal a bar as wide as there is room, with rate and
/// time left; otherwise plain lines every few seconds. Short work shows nothing. Thread-safe.
class Progress {
  public:
    /// `unit` names what is counted, e.g. "Mpx"; `scale` units make up the whole. Without a unit,
    /// no rate is shown. For work that is
    /// part of more, `seconds_left` is the time that all of it takes from now on; it is shown
    /// instead of this part's.
    Progress(std::string label, std::string unit, double scale, bool quiet,
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

    std::string label_;
    std::string unit_;
    double scale_;
    bool quiet_;
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
