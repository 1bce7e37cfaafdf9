#include "cli/info/info_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <system_error>

#include "camera/camera.h"
#include "cli/console.h"
#include "cli/info/camera_path.h"
#include "cli/info/fault_report.h"
#include "cli/info/plume_view.h"
#include "cli/info/scene_survey.h"
#include "cli/info/survey_report.h"
#include "cli/info/vdb_advice.h"
#include "cli/info/vdb_report.h"
#include "core/base/error.h"
#include "core/base/input_files.h"
#include "core/base/output_files.h"
#include "core/base/text.h"
#include "core/image/picture_file.h"
#include "core/image/preview_exposure.h"
#include "core/light/integrator_table.h"
#include "render/image_scene.h"
#include "render/renderer.h"
#include "render/scene_loading.h"

namespace uw {

namespace {

namespace fs = std::filesystem;

/// `uwvdb info` as typed.
struct InfoArguments {
    fs::path subject;                    // a VDB file, a sequence of them, or a scene
    std::vector<std::string> overrides;  // --set key.path=value, of a scene
    std::optional<int> frame;            // --frame, of a sequence; else the first that exists
    bool json = false;
    UpAxis up = UpAxis::automatic;  // --up, of a VDB file
    bool scene = false;             // --scene: print a whole scene instead, of a VDB file
    fs::path picture;               // --picture: a thumbnail of that scene; empty: none
    fs::path svg;                   // --svg: the camera's path over a scene; empty: none
    bool report = false;            // --report: the information for a bug report
};

const char* const k_info_examples = R"(Examples:
  uwvdb info smoke.vdb
  uwvdb info cache/fluid_data_####.vdb --frame 30
  uwvdb info smoke.vdb --scene --picture smoke.png > scene.yaml
  uwvdb info smoke.vdb --up z --scene > scene.yaml
  uwvdb info plume.yaml --set 'volumes[0].grids.density.large=50'
  uwvdb info plume.yaml --json
  uwvdb info dive.yaml --svg path.svg
  uwvdb info plume.yaml --report > report.txt

For a VDB or NanoVDB file: every grid in metres, what is wrong with it, which to map and how, and a
`volumes:` block to paste into a scene, or a whole scene that shows it. For a scene: water, camera,
lamps, how opaque each grid is, how much of it is in view and in a lamp's reach, how clearly it is
seen, and what will be black or opaque. For both it renders small drafts to judge by.
Exit codes: 0 done, 1 internal fault, 2 wrong usage, 3 bad input, 4 cannot read or write.)";

Options info_options(InfoArguments& a) {
    Options options;
    options.input("FILE|SCENE", "", a.subject,
                  "a .vdb or .nvdb file, a sequence, or a scene file; --report needs none");
    options.set(a.overrides);
    options.integer("--frame", "N", a.frame, 0, 999'999'999,
                    "which frame of a sequence, or of a scene that moves; default: the first that "
                    "holds something");
    options.parsed(
        "--up", "x|y|z",
        [&a](const std::string& text) {
            if (text != "x" && text != "y" && text != "z")
                throw UsageError(
                    fmt::format("--up: '{}' is no axis; use x, y or z", printable(text, 300)));
            a.up = text == "x" ? UpAxis::x : text == "y" ? UpAxis::y : UpAxis::z;
        },
        "for a volume: which of the file's axes points up; default: as the file tells");
    options.flag("--scene", a.scene,
                 "for a volume: print a whole scene that shows it, ready to render, and nothing "
                 "else");
    options.output("--picture", "OUT.png", a.picture,
                   "for a volume: write a thumbnail of that scene");
    options.output(
        "--svg", "OUT.svg", a.svg,
        "for a scene that moves: draw the camera's path over it, from above and by height");
    options.flag("--json", a.json, "print everything as JSON");
    options.flag(
        "--report", a.report,
        "print what a report of a fault needs: versions, the machine, the scene's text, the "
        "names of its files, and what 'info' says of it");
    options.confine();
    return options;
}

constexpr int k_shown_variations = 3;

bool is_there(const fs::path& file) {
    std::error_code ignored;
    return fs::exists(file, ignored);
}

void require_file(const fs::path& file) {
    std::error_code error;
    const fs::file_status status = fs::status(file, error);
    const std::string name = printable(file.string(), 300);
    if (status.type() == fs::file_type::not_found)
        throw IoError(stand_in_of(file).empty()
                          ? fmt::format("{}: no such file; check the name", name)
                          : fmt::format("{}: {}", name, stand_in_of(file)));
    // Reading a pipe would keep the program waiting; a device might never end.
    if (!fs::is_regular_file(status))
        throw IoError(fmt::format("{}: is not a file; name a VDB file or a scene", name));
}

/// The folder of the scene file that standard output is redirected to, if that can be told.
fs::path folder_of_printed_scene() {
    std::error_code error;
    const fs::path file = fs::read_symlink("/proc/self/fd/1", error);  // Linux
    const std::string extension = lower_case(file.extension().string());
    const bool is_scene = extension == ".yaml" || extension == ".yml";
    return !error && is_scene && fs::is_regular_file(file, error) ? file.parent_path() : "";
}

/// `file`, named from the current folder, as named from `folder` (absolute, without links).
fs::path named_from(const fs::path& folder, const fs::path& file) {
    std::error_code error;
    if (file.is_absolute() || fs::equivalent(folder, ".", error) || error) return file;
    const fs::path above = fs::weakly_canonical(fs::absolute(file).parent_path(), error);
    if (error) return file;
    return (above / file.filename()).lexically_relative(folder);
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
    constexpr std::size_t k_max_missing = 100'000;
    for (std::size_t i = 1; i < sequence.found.size(); ++i)
        for (int n = sequence.found[i - 1] + 1; n < sequence.found[i]; ++n) {
            if (sequence.missing.size() == k_max_missing) return sequence;
            sequence.missing.push_back(n);
        }
    return sequence;
}

[[noreturn]] void refuse_frame(const fs::path& subject) {
    throw UsageError(
        fmt::format("--frame: '{}' has no sequence and nothing moves; leave the option out",
                    printable(subject.string(), 300)));
}

/// The advice on the sequence that `subject` names, and which of its frames to inspect.
VdbAdvice advise_on_frames(const InfoArguments& a, const fs::path& name, SequenceReport& sequence,
                           const InfoProgress& progress) {
    const FrameSurvey frames = survey_frames(a.subject, sequence.found, a.up);
    sequence.empty = frames.empty;
    sequence.largest = max_values(frames);
    for (const SampledFrame& frame : frames.sampled) sequence.sampled.push_back(frame.frame);
    if (frames.sampled.empty()) return {};
    if (!a.frame) sequence.frame = frames.sampled.front().frame;
    VdbAdvice advice = advise_on_sequence(frames, name, progress);
    for (const std::string& fault : frames.faults)
        advice.lines.push_back("A frame cannot be read: " + fault + ".");
    return advice;
}

VdbSurvey survey_vdb(const InfoArguments& a) {
    Progress shown("looking", "", 1, ProgressForm::text);
    const InfoProgress progress = [&](double done, const std::string& next) {
        shown.update(done, next);
    };
    VdbSurvey survey;
    survey.file = a.subject.string();
    if (a.scene) survey.scene_folder = folder_of_printed_scene();
    const fs::path name =
        survey.scene_folder.empty() ? a.subject : named_from(survey.scene_folder, a.subject);
    fs::path file = a.subject;
    const bool is_sequence = !is_there(a.subject) && has_frame_pattern(a.subject.string());
    if (is_sequence) {
        survey.sequence = look_for_frames(a.subject, a.frame);
        if (a.frame) require_file(file_of_frame(a.subject, *a.frame));
        survey.advice = advise_on_frames(a, name, survey.sequence, progress);
        file = file_of_frame(a.subject, survey.sequence.frame);
    } else if (a.frame) {
        refuse_frame(a.subject);
    }
    require_file(file);
    survey.inspection = inspect_vdb(file, printable(file.filename().string(), 300), a.up);
    if (!is_sequence || survey.advice.map.empty()) {
        survey.advice = advise_on_vdb(survey.inspection, name, progress);
        if (is_sequence)
            survey.advice.lines.emplace_back("No frame of the sequence holds anything to map.");
    }
    return survey;
}

/// Renders the proposed scene, small, and writes it as a PNG.
void write_thumbnail(const VdbSurvey& survey, const fs::path& file) {
    SceneDesc desc = load_scene_text(survey.advice.scene, survey.scene_folder / "scene.yaml");
    const std::shared_ptr<const ColourView> view = colour_view(desc.render.view);
    resize_image(desc.camera, k_picture_width, k_picture_height);
    if (scattering_of(desc.render) == RenderDesc::Scattering::multiple)
        desc.render.quality = RenderDesc::Quality::draft;  // seconds, not minutes
    ImageChoice choice;
    if (!survey.sequence.pattern.empty()) choice.frame = survey.sequence.frame;
    Renderer renderer;
    renderer.set_scene({std::move(desc), choice});
    const Film& film = renderer.render();
    OutputFile out(file);
    write_picture(out, film,
                  {.exposure = automatic_exposure(film).value_or(1.0), .view = view.get()}, {});
    out.commit();
    print_message(fmt::format("wrote {}\n", printable(file.string(), 300)));
}

std::string info_on_vdb(const InfoArguments& a) {
    if (!a.svg.empty())
        throw UsageError("--svg: draws the path of a scene's camera; a VDB file has none");
    if (!a.overrides.empty())
        throw UsageError("--set: works only on scenes; a VDB file has nothing to set");
    if (a.scene && a.json)
        throw UsageError("--scene and --json: give one; the scene is in the JSON, too");
    if (!a.picture.empty() && a.picture.extension() != ".png")
        throw UsageError(fmt::format("--picture: '{}' does not end in .png",
                                     printable(a.picture.string(), 300)));
    check_outputs({a.picture});
    const VdbSurvey survey = survey_vdb(a);
    check_outputs({a.picture});  // which may be one of the files read
    if ((a.scene || !a.picture.empty()) && survey.advice.map.empty())
        throw InputError(fmt::format("{}: {} There is no scene to show; see 'uwvdb info' of it",
                                     printable(a.subject.filename().string(), 300),
                                     survey.advice.lines.front()));
    if (!a.picture.empty()) write_thumbnail(survey, a.picture);
    if (a.scene) return survey.advice.scene;
    return report_on_vdb(survey).printed(a.json);
}

/// How clearly the volumes of a scene are visible in a draft of this width. Leaves them loaded.
DraftContrast draft_contrast(Renderer& renderer, const ImageScene& scene, int width) {
    const ImageScene with = quick_draft_of(scene, width);
    renderer.set_scene(with.with([](SceneDesc& desc) {
        desc.volumes.clear();
        // An emissive volume is a lamp, which names its volume.
        std::erase_if(desc.lamps,
                      [](const LampDesc& lamp) { return lamp.emissive_volume.has_value(); });
    }));
    renderer.render();
    const Film before = renderer.release_film();
    renderer.set_scene(with);
    const Film& film = renderer.render();
    return compare_drafts(renderer.assembled(), film, before);
}

/// The same; none if the scene has no volume, or no lamps other than emissive volumes: the picture
/// without these would be black.
std::optional<DraftContrast> draft_contrast(Renderer& renderer, const ImageScene& scene) {
    const auto is_emissive = [](const LampDesc& lamp) { return lamp.emissive_volume.has_value(); };
    if (scene.desc().volumes.empty() || std::ranges::all_of(scene.desc().lamps, is_emissive))
        return std::nullopt;
    const DraftContrast draft = draft_contrast(renderer, scene, k_draft_width);
    if (draft.seen >= k_min_seen) return draft;
    return draft_contrast(renderer, scene, k_fine_draft_width);
}

void write_path_plot(const InfoArguments& a, const std::optional<PathSurvey>& path,
                     const Surfaces& surfaces) {
    if (!path)
        throw InputError(fmt::format(
            "{}: there is no frame in which everything that moves has a pose, so no path to draw",
            printable(a.subject.filename().string(), 300)));
    TextFiles files;
    files.add(a.svg, path_plot(*path, surfaces, a.subject.filename().string()));
    files.commit();
}

/// Draws the first few variations of a scene and reads their scenes; none if it has no variations.
std::optional<VariationsSurvey> survey_variations(const InfoArguments& a) {
    const SceneVariations variations(a.subject, a.overrides);
    if (!variations.desc()) return std::nullopt;
    VariationsSurvey survey{*variations.desc(), {}};
    for (int i = 0; i < k_shown_variations; ++i) {
        variations.scene(i);  // throws if it is none
        survey.first.push_back(variations.values(i));
    }
    return survey;
}

std::string info_on_scene(const InfoArguments& a) {
    if (a.scene || !a.picture.empty())
        throw UsageError(fmt::format("{}: is for volumes; a scene is rendered with 'uwvdb render'",
                                     a.scene ? "--scene" : "--picture"));
    if (a.up != UpAxis::automatic)
        throw UsageError("--up: is for volumes; a scene says it itself, as volumes[].up");
    const SceneDesc all = load_scene(a.subject, a.overrides);
    if (!a.svg.empty() && !has_motion(all))
        throw UsageError("--svg: draws the path of a camera, but nothing in this scene moves");
    std::vector<SequenceReport> sequences;
    std::optional<int> frame = a.frame;
    const auto look = [&](const auto& input) {
        if (!input.is_sequence) return;
        sequences.push_back(look_for_frames(input.file, frame));
        frame = sequences.back().frame;
    };
    std::ranges::for_each(all.volumes, look);
    std::ranges::for_each(all.geometry, look);
    if (sequences.empty() && a.frame && !has_motion(all)) refuse_frame(a.subject);
    const ImageScene scene = scene_of_image(all, {frame});
    Renderer renderer;
    const std::optional<DraftContrast> contrast = draft_contrast(renderer, scene);
    renderer.set_scene(scene);
    SceneSurvey survey = survey_scene(renderer.assemble(), contrast);
    survey.sequences = std::move(sequences);
    const Surfaces& surfaces = *renderer.assembled().surfaces;
    survey.path = survey_path(all, surfaces);
    survey.variations = survey_variations(a);
    for (const fs::path& file : inputs_outside(fs::weakly_canonical(a.subject).parent_path()))
        survey.files_outside.push_back(printable(file.string(), 300));
    if (!a.svg.empty()) write_path_plot(a, survey.path, surfaces);
    return report_on_scene(survey).printed(a.json);
}

/// Whether VDB readers should read it: by its name, or else by its first bytes.
bool is_volume_file(const fs::path& file) {
    const std::string extension = lower_case(file.extension().string());
    if (extension == ".vdb" || extension == ".nvdb") return true;
    std::string beginning(8, '\0');
    open_own_file(file).read(beginning.data(), static_cast<std::streamsize>(beginning.size()));
    return beginning == std::string(" BDV\0\0\0\0", 8) || beginning.starts_with("NanoVDB");
}

std::string info_text(const InfoArguments& a) {
    return is_volume_file(a.subject) ? info_on_vdb(a) : info_on_scene(a);
}

void print_report(const InfoArguments& a) {
    if (a.json || a.scene || !a.picture.empty() || !a.svg.empty())
        throw UsageError(
            "--report: is text to be read and sent; leave out --json, --scene, --picture and "
            "--svg");
    print_fault_report(
        {a.subject, !is_volume_file(a.subject), a.overrides, [&a] { return info_text(a); }});
}

}  // namespace

Command info_command() {
    const auto arguments = std::make_shared<InfoArguments>();
    return {"info", "show what a VDB file or a scene holds, and what to fix", k_info_examples,
            info_options(*arguments), [arguments] {
                const InfoArguments& a = *arguments;
                if (a.report) {
                    print_report(a);
                    return k_exit_done;
                }
                if (a.subject.empty())
                    throw UsageError("info: which scene or VDB file? see 'uwvdb info --help'");
                print_output(info_text(a));
                return k_exit_done;
            }};
}

}  // namespace uw
