#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "media/vdb/vdb_inspect.h"

namespace uw {

/// One frame of a sequence, with what is in it.
struct SampledFrame {
    int frame = 0;
    VdbInspection inspection;
};

/// What the frames of a sequence hold.
struct FrameSurvey {
    std::vector<int> empty;             // by their headers hold nothing that could be mapped
    std::vector<SampledFrame> sampled;  // some of the others, spread evenly from first to last
    std::vector<std::string> faults;    // of frames that cannot be read, one line each

    /// The first of the sampled frames; nullptr if none holds anything.
    const SampledFrame* first() const { return sampled.empty() ? nullptr : &sampled.front(); }
};

/// Reads the headers of all `frames` that exist of the sequence, and all of a few of them.
FrameSurvey survey_frames(const std::filesystem::path& pattern, const std::vector<int>& frames);

/// The largest value of the grid likeliest to be a concentration, per sampled frame.
std::vector<double> largest_values(const FrameSurvey& survey);

}  // namespace uw
