#include "cli/render/run_stats.h"

#include <sys/resource.h>

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <utility>

#include "cli/render/picture_numbers.h"
#include "core/base/csv_table.h"
#include "core/base/error.h"
#include "core/base/json.h"
#include "core/base/output_files.h"
#include "core/base/version.h"

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

void RunStats::add_stage(const std::string& name, double seconds) {
    stages_.emplace_back(name, seconds);
}

void RunStats::count(const std::string& name, std::uint64_t value) {
    counts_.emplace_back(name, value);
}

void RunStats::measure(const std::string& name, double value) {
    measures_.emplace_back(name, value);
}

void RunStats::measure(const std::string& name, std::vector<double> values) {
    lists_.emplace_back(name, std::move(values));
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

void RunStats::set_output(const std::string& name, std::optional<int> frame) {
    output_ = name;
    frame_ = frame;
}

/// The only user of the JSON library here.
struct StatsJson {
    static Json begin(const std::string& scene) {
        Json json;
        json["uwvdb"] = program_version();
        json["scene"] = scene;
        return json;
    }

    // Null for none and for infinity; counts without a decimal point.
    static Json number_json(const std::optional<double>& value) {
        if (!value || !std::isfinite(*value)) return {};
        const bool is_whole = *value == std::floor(*value) && std::abs(*value) < 1e15;
        return is_whole ? Json(static_cast<std::int64_t>(*value)) : Json(*value);
    }

    static void add(const RunStats& stats, Json& json) {
        if (stats.frame_) json["frame"] = *stats.frame_;
        json["output"] = stats.output_;
        for (const auto& [name, seconds] : stats.stages_) json["seconds"][name] = seconds;
        json["seconds"]["total"] = stats.total_seconds();
        for (const auto& [name, value] : stats.counts_) json[name] = value;
        for (const auto& [name, value] : stats.measures_) json[name] = value;
        for (const auto& [name, values] : stats.lists_) json[name] = values;
        for (const PartNumbers& row : stats.numbers_) {
            Json& numbers = json["numbers"].emplace_back();
            numbers["part"] = row.part;
            numbers["lamp"] = row.lamp.empty() ? Json() : Json(row.lamp);
            for (const NumberColumn& column : number_columns()) {
                const std::optional<double> value = column.value(row.numbers);
                numbers[std::string(column.name)] = number_json(value);
            }
        }
    }

    static void write(const std::filesystem::path& file, Json json) {
        json["peak_memory_bytes"] = RunStats::peak_memory_bytes();
        AtomicFile target(file);
        std::ofstream out(target.temporary_path());
        out << json_text(json);
        out.close();
        if (!out) throw IoError(fmt::format("{}: cannot write; is the disk full?", file.string()));
        target.commit();
    }
};

std::string RunStats::numbers_csv_header() {
    return "image,frame,part,lamp" + number_names_csv() + "\n";
}

std::string RunStats::numbers_table() const {
    return fmt::format("{}\n{}", output_, numbers_text(numbers_));
}

std::string RunStats::numbers_csv() const {
    std::string text;
    for (const PartNumbers& row : numbers_)
        text += fmt::format("{},{},{},{}{}\n", csv_text(output_),
                            frame_ ? fmt::format("{}", *frame_) : "", csv_text(row.part),
                            csv_text(row.lamp.empty() ? "all" : row.lamp),
                            number_values_csv(row.numbers));
    return text;
}

void RunStats::write_json(const std::filesystem::path& file, const std::string& scene) const {
    Json json = StatsJson::begin(scene);
    StatsJson::add(*this, json);
    StatsJson::write(file, std::move(json));
}

void RunStats::write_json(const std::filesystem::path& file, const std::string& scene,
                          std::span<const RunStats> images) {
    Json json = StatsJson::begin(scene);
    json["frames"] = Json::array();
    for (const RunStats& stats : images) StatsJson::add(stats, json["frames"].emplace_back());
    StatsJson::write(file, std::move(json));
}

}  // namespace uw
