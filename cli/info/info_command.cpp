#include "cli/info/info_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <memory>
#include <optional>
#include <system_error>

#include "cli/console.h"
#include "cli/info/scene_survey.h"
#include "cli/info/survey_json.h"
#include "cli/info/survey_text.h"
#include "cli/info/vdb_advice.h"
#include "cli/info/vdb_json.h"
#include "cli/info/vdb_text.h"
#include "core/base/error.h"
#include "core/base/frame_pattern.h"
#include "core/base/text.h"
#include "render/renderer.h"
#include "render/scene_loading.h"

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
    // Reading a pipe would keep the program waiting; a device might never end.
    if (!fs::is_regular_file(status))
        throw IoError(fmt::format("{}: is not a file; name a VDB file or a scene", name));
}

/// The existing frames of a sequence, and which of them to inspect.
SequenceReport look_for_frames(const fs::path& pattern, const std::optional<int>& frame) {
    SequenceReport sequence;
    sequence.pattern = pattern.string();
    sequence.found = frames_found(pattern);
    if (sequence.found.empty() && !frame)
        throw IoError(fmt::format("{}: no file of this sequence exists; check the name",
                                  printable(sequence.pattern, 300)));
    sequence.frame = frame ? *frame : sequence.found.front();
    constexpr std::size_t k_most_missing = 100'000;
    for (std::size_t i = 1; i < sequence.found.size(); ++i)
        for (int n = sequence.found[i - 1] + 1; n < sequence.found[i]; ++n) {
            if (sequence.missing.size() == k_most_missing) return sequence;
            sequence.missing.push_back(n);
        }
    return sequence;
}

[[noreturn]] void refuse_frame(const fs::path& subject) {
    throw UsageError(fmt::format("--frame: '{}' has no sequence; leave the option out",
                                 printable(subject.string(), 300)));
}

std::string info_on_vdb(const InfoArguments& a) {
    if (!a.overrides.empty())
        throw UsageError("--set: works only on scenes; a VDB file has nothing to set");
    VdbReport report;
    report.file = a.subject.string();
    fs::path file = a.subject;
    if (!is_there(a.subject) && has_frame_pattern(a.subject.string())) {
        report.sequence = look_for_frames(a.subject, a.frame);
        file = file_of_frame(a.subject, report.sequence.frame);
    } else if (a.frame) {
        refuse_frame(a.subject);
    }
    require_file(file);
    report.inspection = inspect_vdb(file, printable(file.filename().string(), 300));
    report.advice = advise_on_vdb(report.inspection, a.subject);
    return a.json ? vdb_json(report) : vdb_text(report);
}

std::string info_on_scene(const InfoArguments& a) {
    SceneDesc desc = load_scene(a.subject, a.overrides);
    std::vector<SequenceReport> sequences;
    std::optional<int> frame = a.frame;
    const auto look = [&](const auto& input) {
        if (!input.is_sequence) return;
        sequences.push_back(look_for_frames(input.file, frame));
        frame = sequences.back().frame;
    };
    std::ranges::for_each(desc.volumes, look);
    std::ranges::for_each(desc.geometry, look);
    if (sequences.empty() && a.frame) refuse_frame(a.subject);
    if (!sequences.empty()) desc = scene_of_image(desc, {frame});
    Renderer renderer;
    renderer.set_scene(std::move(desc));
    SceneSurvey survey = survey_scene(renderer.assemble());
    survey.sequences = std::move(sequences);
    return a.json ? survey_json(survey) : survey_text(survey);
}

/// Whether VDB readers should read it: by its name, or else by its first bytes.
bool is_volume_file(const fs::path& file) {
    std::string extension = file.extension().string();
    for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (extension == ".vdb" || extension == ".nvdb") return true;
    std::error_code ignored;
    if (!fs::is_regular_file(file, ignored)) return false;
    std::string beginning(8, '\0');
    std::ifstream(file, std::ios::binary)
        .read(beginning.data(), static_cast<std::streamsize>(beginning.size()));
    return beginning == std::string(" BDV\0\0\0\0", 8) || beginning.starts_with("NanoVDB");
}

}  // namespace

std::string run_info(const InfoArguments& a) {
    return is_volume_file(a.subject) ? info_on_vdb(a) : info_on_scene(a);
}

Command info_command() {
    const auto arguments = std::make_shared<InfoArguments>();
    return {"info", "show what a VDB file or a scene holds, and what to fix", k_info_examples,
            info_options(*arguments), [arguments] {
                print_output(run_info(*arguments));
                return k_exit_done;
            }};
}

}  // namespace uw
