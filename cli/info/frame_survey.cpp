#include "cli/info/frame_survey.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "cli/info/grid_choice.h"
#include "core/base/error.h"
#include "core/base/frame_pattern.h"
#include "core/base/text.h"
#include "media/vdb/grid_selection.h"
#include "media/vdb/vdb_header_reader.h"

namespace uw {

namespace {

constexpr std::size_t k_most_sampled = 6;
constexpr std::size_t k_most_faults = 3;

/// Whether a grid of the file may hold a concentration, as far as its header tells.
bool may_hold_something(const VdbHeader& header) {
    return std::ranges::any_of(header.grids, [](const GridSummary& grid) {
        return unusable_because(grid).empty() && concentration_likelihood(grid.base_name) > 0 &&
               grid.active_voxels.value_or(1) > 0;
    });
}

}  // namespace

FrameSurvey survey_frames(const std::filesystem::path& pattern, const std::vector<int>& frames) {
    FrameSurvey survey;
    const auto guarded = [&](int frame, const auto& look) {
        const std::filesystem::path file = file_of_frame(pattern, frame);
        try {
            look(file, printable(file.filename().string(), 300));
        } catch (const std::runtime_error& error) {
            if (survey.faults.size() < k_most_faults) survey.faults.emplace_back(error.what());
        }
    };
    std::vector<int> candidates;
    for (const int frame : frames)
        guarded(frame, [&](const std::filesystem::path& file, const std::string& name) {
            const bool holds = may_hold_something(read_vdb_header(file, name));
            (holds ? candidates : survey.empty).push_back(frame);
        });
    const std::size_t count = std::min(candidates.size(), k_most_sampled);
    for (std::size_t n = 0; n < count; ++n) {
        const int frame = candidates[count == 1 ? 0 : n * (candidates.size() - 1) / (count - 1)];
        guarded(frame, [&](const std::filesystem::path& file, const std::string& name) {
            SampledFrame sampled{frame, inspect_vdb(file, name)};
            if (likeliest_grid(sampled.inspection) != nullptr)
                survey.sampled.push_back(std::move(sampled));
            else
                survey.empty.push_back(frame);
        });
    }
    std::ranges::sort(survey.empty);
    return survey;
}

std::vector<double> largest_values(const FrameSurvey& survey) {
    std::vector<double> values;
    for (const SampledFrame& frame : survey.sampled)
        values.push_back(likeliest_grid(frame.inspection)->values->max);
    return values;
}

}  // namespace uw
