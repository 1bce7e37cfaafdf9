#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "render/measures/picture_numbers.h"

namespace uw {

/// Seconds that each stage of a run took, and what it worked on: `--stats`.
class RunStats {
  public:
    RunStats() : stage_start_(std::chrono::steady_clock::now()) {}

    /// Ends the current stage, if any, and begins `name`.
    void begin_stage(const std::string& name);
    void end_stage();
    /// Adds a stage that has been timed elsewhere.
    void add_stage(const std::string& name, double seconds);
    /// Adds a figure, e.g. count("camera_rays", 1e6).
    void count(const std::string& name, std::uint64_t value);
    /// Adds a number that is no count.
    void measure(const std::string& name, double value);

    double total_seconds() const;
    /// Largest resident memory of the process so far [bytes].
    static std::uint64_t peak_memory_bytes();

    /// Identifies the image: its name, and its number in a sequence.
    void set_output(const std::string& name, std::optional<int> frame);

    /// Adds what was measured in the image.
    void set_numbers(std::vector<PartNumbers> numbers) { numbers_ = std::move(numbers); }
    /// The rows of these numbers in a CSV, each beginning with the image's name and its number.
    std::string numbers_csv() const;
    /// The most important of them as aligned text, under the image's name.
    std::string numbers_table() const;
    /// The names of the CSV's columns.
    static std::string numbers_csv_header();

    /// Writes everything as JSON. Throws IoError.
    void write_json(const std::filesystem::path& file, const std::string& scene) const;
    /// Writes one JSON file about several images, which are listed under `frames`.
    static void write_json(const std::filesystem::path& file, const std::string& scene,
                           std::span<const RunStats> images);

  private:
    friend struct StatsJson;

    std::vector<std::pair<std::string, double>> stages_;
    std::vector<std::pair<std::string, std::uint64_t>> counts_;
    std::vector<std::pair<std::string, double>> measures_;
    std::vector<PartNumbers> numbers_;
    std::string output_;
    std::optional<int> frame_;
    std::string stage_;
    std::chrono::steady_clock::time_point stage_start_;
};

/// How far a run of several images has got, and how long it will take.
class SequenceClock {
  public:
    /// `noun`: what messages call one of them.
    explicit SequenceClock(std::size_t images, std::string noun = "frame")
        : images_(images), noun_(std::move(noun)) {}

    void finish_image() { ++done_; }
    std::size_t images_done() const { return done_; }
    bool finished() const { return done_ == images_; }
    bool is_sequence() const { return images_ > 1; }

    /// "frame 3 of 10: render"; of a single image "render".
    std::string label(const std::string& pass) const {
        if (!is_sequence()) return pass;
        return noun_ + " " + std::to_string(done_ + 1) + " of " + std::to_string(images_) + ": " +
               pass;
    }

    /// From now until all images are done, if they take as long as those before [s]; empty until
    /// the first is done.
    std::optional<double> seconds_left() const {
        if (!is_sequence() || done_ == 0) return std::nullopt;
        const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start_;
        return elapsed.count() * static_cast<double>(images_ - done_) / static_cast<double>(done_);
    }

  private:
    std::size_t images_;
    std::string noun_;
    std::size_t done_ = 0;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace uw
