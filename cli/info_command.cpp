#include "cli/info_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <system_error>

#include "cli/vdb_report.h"
#include "core/config_text.h"
#include "core/error.h"
#include "core/frame_pattern.h"

namespace uw {

namespace {

namespace fs = std::filesystem;

bool is_there(const fs::path& file) {
    std::error_code ignored;
    return fs::exists(file, ignored);
}

void require_file(const fs::path& file) {
    std::error_code error;
    const fs::file_status status = fs::status(file, error);
    const std::string name = printable(file.string(), 300);
    if (status.type() == fs::file_type::not_found)
        throw IoError(fmt::format("{}: no such file; check the name", name));
    // A pipe would keep the program waiting, a device might never end.
    if (!fs::is_regular_file(status))
        throw IoError(fmt::format("{}: is not a file; name a VDB file or a scene", name));
}

SequenceReport look_for_frames(const InfoArguments& a) {
    SequenceReport sequence;
    if (is_there(a.subject) || !has_frame_pattern(a.subject.string())) {
        if (a.frame)
            throw UsageError(fmt::format("--frame: '{}' is one file, not a sequence; leave it out",
                                         printable(a.subject.string(), 300)));
        return sequence;
    }
    sequence.pattern = a.subject.string();
    sequence.found = frames_found(a.subject);
    if (a.frame) {
        sequence.frame = *a.frame;
    } else if (sequence.found.empty()) {
        throw IoError(fmt::format("{}: there is no file of this sequence; check the name",
                                  printable(sequence.pattern, 300)));
    } else {
        sequence.frame = sequence.found.front();
    }
    constexpr std::size_t k_most_missing = 100'000;
    for (std::size_t i = 1; i < sequence.found.size(); ++i)
        for (int n = sequence.found[i - 1] + 1; n < sequence.found[i]; ++n)
            if (sequence.missing.size() < k_most_missing)
                sequence.missing.push_back(n);
            else
                return sequence;
    return sequence;
}

std::string info_on_vdb(const InfoArguments& a) {
    if (!a.overrides.empty())
        throw UsageError("--set: is for scenes; a VDB file has nothing to set");
    VdbReport report;
    report.file = a.subject.string();
    report.sequence = look_for_frames(a);
    const bool is_sequence = !report.sequence.pattern.empty();
    const fs::path file = is_sequence ? file_of_frame(a.subject, report.sequence.frame) : a.subject;
    require_file(file);
    report.inspection = inspect_vdb(file, printable(file.filename().string(), 300));
    report.advice = advise_on_vdb(report.inspection, a.subject);
    return a.json ? vdb_json(report) : vdb_text(report);
}

}  // namespace

std::string run_info(const InfoArguments& a) {
    return info_on_vdb(a);
}

}  // namespace uw
