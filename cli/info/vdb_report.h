#pragma once

#include <string>
#include <vector>

#include "cli/info/vdb_advice.h"

namespace uw {

/// The files of a sequence.
struct SequenceReport {
    std::string pattern;              // empty: it is one file
    int frame = 0;                    // the one inspected
    std::vector<int> found, missing;  // missing: between the first and the last found
    // Of a sequence of volumes:
    std::vector<int> empty;       // frames that hold nothing to map
    std::vector<int> sampled;     // frames of which all was read
    std::vector<double> largest;  // largest value of the grid to map, of each of these
};

/// What `uwvdb info` says about a VDB file.
struct VdbReport {
    std::string file;  // as typed
    SequenceReport sequence;
    VdbInspection inspection;
    VdbAdvice advice;
};

/// A report for people: grids, advice, and the block to paste.
std::string vdb_text(const VdbReport& report);

/// "none", "zip", "blosc, active values only" and so on.
std::string compression_of(const GridSummary& grid);
/// How many bits its numbers have in the file: "half", "float", "fp8" and so on.
std::string precision_of(const GridSummary& grid);

/// A report as one JSON object (docs/command-line.md).
std::string vdb_json(const VdbReport& report);

}  // namespace uw
