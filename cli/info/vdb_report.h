#pragma once

#include <string>
#include <vector>

#include "cli/info/vdb_advice.h"

namespace uw {

/// The files of a sequence.
struct SequenceReport {
    std::string pattern;              // empty: it is one file
    int frame = 0;                    // the one looked at
    std::vector<int> found, missing;  // missing: between the first and the last found
};

/// What `uwvdb info` says of a VDB file.
struct VdbReport {
    std::string file;  // as typed
    SequenceReport sequence;
    VdbInspection inspection;
    VdbAdvice advice;
};

/// For people: grids, advice, and the block to paste.
std::string vdb_text(const VdbReport& report);
/// The same as one JSON object (docs/command-line.md).
std::string vdb_json(const VdbReport& report);

/// "none", "zip", "blosc, active values only" and so on.
std::string compression_of(const GridSummary& grid);
/// How many bits its numbers have in the file: "half", "float", "fp8" and so on.
std::string precision_of(const GridSummary& grid);

}  // namespace uw
