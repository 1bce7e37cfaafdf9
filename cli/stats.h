#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace uw {

/// Seconds that each stage of a run took, and what it worked on: `--stats`.
class RunStats {
  public:
    RunStats() : stage_start_(std::chrono::steady_clock::now()) {}

    /// Ends the stage under way, if any, and begins `name`.
    void begin_stage(const std::string& name);
    void end_stage();
    /// Adds a figure, e.g. count("camera_rays", 1e6).
    void count(const std::string& name, std::uint64_t value);

    double total_seconds() const;
    /// Largest resident memory of the process so far [bytes].
    static std::uint64_t peak_memory_bytes();

    /// Writes everything as JSON. Throws IoError.
    void write_json(const std::filesystem::path& file, const std::string& scene,
                    const std::string& output) const;

  private:
    std::vector<std::pair<std::string, double>> stages_;
    std::vector<std::pair<std::string, std::uint64_t>> counts_;
    std::string stage_;
    std::chrono::steady_clock::time_point stage_start_;
};

}  // namespace uw
