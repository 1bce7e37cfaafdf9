#include "cli/stats.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "cli/version.h"
#include "core/atomic_file.h"
#include "core/error.h"

namespace uw {

void RunStats::begin_stage(const std::string& name) {
    end_stage();
    stage_ = name;
    stage_start_ = std::chrono::steady_clock::now();
}

void RunStats::end_stage() {
    if (stage_.empty()) return;
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - stage_start_;
    stages_.emplace_back(stage_, elapsed.count());
    stage_.clear();
}

void RunStats::count(const std::string& name, std::uint64_t value) {
    counts_.emplace_back(name, value);
}

double RunStats::total_seconds() const {
    double total = 0;
    for (const auto& [name, seconds] : stages_) total += seconds;
    return total;
}

std::uint64_t RunStats::peak_memory_bytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;  // Linux counts in KiB
}

void RunStats::write_json(const std::filesystem::path& file, const std::string& scene,
                          const std::string& output) const {
    nlohmann::ordered_json json;
    json["uwvdb"] = program_version();
    json["scene"] = scene;
    json["output"] = output;
    for (const auto& [name, seconds] : stages_) json["seconds"][name] = seconds;
    json["seconds"]["total"] = total_seconds();
    for (const auto& [name, value] : counts_) json[name] = value;
    json["peak_memory_bytes"] = peak_memory_bytes();
    AtomicFile target(file);
    std::ofstream out(target.temporary_path());
    out << json.dump(2) << "\n";
    out.close();
    if (!out) throw IoError(fmt::format("{}: cannot write", file.string()));
    target.commit();
}

}  // namespace uw
