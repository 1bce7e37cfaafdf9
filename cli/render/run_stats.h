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
    /// Adds one such number per band.
    void measure(const std::string& name, std::vector<double> values);

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
    std::vector<std::pair<std::string, std::vector<double>>> lists_;
    std::vector<PartNumbers> numbers_;
    std::string output_;
    std::optional<int> frame_;
    std::string stage_;
    std::chrono::steady_clock::time_point stage_start_;
};

}  // namespace uw
