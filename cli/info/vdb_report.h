#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cli/info/vdb_advice.h"
#include "cli/report.h"

namespace uw {

/// The files of a sequence.
struct SequenceReport {
    std::string pattern;              // empty: it is one file
    int frame = 0;                    // the one inspected
    std::vector<int> found, missing;  // missing: between the first and the last found
    // What sequences of volumes have, too:
    std::vector<int> empty;       // frames with nothing to map
    std::vector<int> sampled;     // frames that were read completely
    std::vector<double> largest;  // largest value of the grid to map, of each of these
};

/// What `uwvdb info` says about a VDB file.
struct VdbSurvey {
    std::string file;  // as typed
    /// The folder relative to which the scene names the file; empty: the current one.
    std::filesystem::path scene_folder;
    SequenceReport sequence;
    VdbInspection inspection;
    VdbAdvice advice;
};

/// Its grids, advice, and a scene to paste (docs/command-line.md has the keys).
Report report_on_vdb(const VdbSurvey& survey);

}  // namespace uw
