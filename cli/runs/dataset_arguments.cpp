#include "cli/runs/dataset_arguments.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>

#include "cli/image_choice.h"
#include "cli/pages/shell.h"
#include "cli/render/frame_sequence.h"
#include "cli/render/run_scenes.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/version.h"
#include "core/scene/render_desc.h"
#include "dataset/formats.h"
#include "render/image_scene.h"
#include "render/scene_loading.h"

namespace uw {

namespace {

constexpr const char* k_dataset_examples = R"(Examples:
  uwvdb dataset assets/scenes/dive.yaml -o dive --format png,depth,flow,mask
  uwvdb dataset dive.yaml -o dive --format colmap,nerfstudio,tum --frames 0-47:2 --size 640x480
  uwvdb dataset dive.yaml -o pairs --format clean --quality draft
  uwvdb dataset dive.yaml -o dive --format png,flow --shard 3/8
  uwvdb dataset --merge dive
  uwvdb dataset dive.yaml -o /shared/dive --slurm 100 --slurm-options '--partition=long'

Renders all frames in which everything that moves has a pose (or --frames), by all cameras of a rig,
and writes them as --format says, with a data card (README.md), a manifest, checksums, a contact sheet
and a page to look at (index.html). The same command continues a run that was interrupted, whatever
interrupted it: what is there and whole is kept, and the result is the same to the byte. A folder that
holds another set is refused. Processes that each render a --shard of the same set, on one machine or
many, may share the folder; --merge then checks it and completes it.

Formats:
)";

constexpr const char* k_dataset_exit_codes = R"(
Exit codes: 0 done, 1 internal fault, 2 wrong usage, 3 bad input, 4 cannot read or write,
130 interrupted. More: docs/datasets.md)";

constexpr std::size_t k_max_shards = 1'000'000;

ShardArgument shard_in(const std::string& text) {
    ShardArgument shard;
    const char* const end = text.data() + text.size();
    const auto [slash, fault] = std::from_chars(text.data(), end, shard.number);
    if (fault == std::errc() && slash != end && *slash == '/') {
        const auto [last, error] = std::from_chars(slash + 1, end, shard.count);
        if (error == std::errc() && last == end && shard.number >= 1 &&
            shard.number <= shard.count && shard.count <= k_max_shards)
            return shard;
    }
    throw UsageError(fmt::format("--shard: expected I/N with 1 <= I <= N, such as 3/8; found '{}'",
                                 printable(text)));
}

/// The words of a list with commas between them, each once, without blanks around them.
std::vector<std::string> words_in(const std::string& option, const std::string& text) {
    std::vector<std::string> words;
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find(',', begin), text.size());
        const std::size_t first = text.find_first_not_of(' ', begin);
        if (first >= end)
            throw UsageError(fmt::format("{}: a name is missing in '{}'", option, printable(text)));
        const std::string word =
            text.substr(first, text.find_last_not_of(' ', end - 1) + 1 - first);
        if (std::ranges::find(words, word) == words.end()) words.push_back(word);
        begin = end + 1;
    }
    return words;
}

void add_output_options(Options& options, DatasetArguments& a) {
    Option& format = options.parsed(
        "--format", "A,B",
        [&a](const std::string& text) {
            for (const std::string& name : words_in("--format", text)) {
                dataset_format(name);  // throws for one that does not exist
                if (std::ranges::find(a.formats, name) == a.formats.end())
                    a.formats.push_back(name);
            }
        },
        "what to write, separated by commas: see below; default: png,depth");
    format.value = Option::Value::word_list;
    format.repeatable = true;
    for (const DatasetFormat& known : dataset_formats()) format.words.emplace_back(known.name);
    options.text("--layers", "NAMES", a.image.layers,
                 "further layers of exr and npy, as render has them");
    options.parsed(
        "--exposure", "N|auto",
        [&a](const std::string& text) {
            double factor = 0;
            if (text == "auto") return;
            if (parse_number(text, factor) != NumberText::number || !(factor > 0))
                throw UsageError(fmt::format(
                    "--exposure: expected a number above 0 or auto, found '{}'", printable(text)));
            a.exposure = factor;
        },
        "expose the images of a camera without sensor by a factor; auto: one that suits all views");
    Option& bits = options.parsed(
        "--image-bits", "N",
        [&a](const std::string& text) {
            if (text != "8" && text != "16")
                throw UsageError(
                    fmt::format("--image-bits: expected 8 or 16, found '{}'", printable(text)));
            a.image.preview_bits = text == "16" ? 16 : 8;
        },
        "bits of these images: 8, the default, or 16");
    bits.value = Option::Value::word;
    bits.words = {"8", "16"};
    options.number("--depth-scale", "N", a.depth_scale, 0, 1e9,
                   "scale of 16-bit depth: N per metre; default 1000");
    options.number("--depth-far", "D", a.depth_far, 0, 1e9,
                   "leave out of 16-bit depth what is farther than D metres");
    options.flag(
        "--pinhole-fit", a.pinhole_fit,
        "fit the cameras of colmap, nerfstudio, euroc and mcap, which know no port, to what is "
        "seen through it, instead of giving them as they are in air");
    options.text("--licence", "TEXT", a.licence, "licence of the set, for its data card");
}

}  // namespace

std::string dataset_examples() {
    std::string text = k_dataset_examples;
    for (const DatasetFormat& format : dataset_formats())
        text += fmt::format("  {:<12} {}\n", format.name, format.summary);
    return text + k_dataset_exit_codes;
}

Options dataset_options(DatasetArguments& a) {
    Options options;
    options.input("SCENE", "", a.image.scene, "scene file (docs/scene-file.md)");
    options.output(
        "-o,--output", "FOLDER", a.image.output,
        "the folder of the set; default: the scene's name with -dataset, in this folder");
    options.parsed(
        "--frames", "1-10,20-40:2|all",
        [&a](const std::string& text) {
            a.frames = text;
            a.image.all_frames = text == "all";
            if (!a.image.all_frames) a.image.frames = parse_frame_list(text);
        },
        "these frames; default: all in which everything that moves has a pose");
    options.parsed(
        "--cameras", "NAMES",
        [&a](const std::string& text) { a.cameras = words_in("--cameras", text); },
        "only these cameras of a rig, separated by commas");
    options.integer("--variations", "N", a.image.variation_count, 1, 100'000,
                    "all of it in N scenes, whose values are drawn as the scene's section "
                    "variations says");
    options.set(a.image.overrides);
    options.size(a.image.size, "render at this size, the intrinsics scaled with it");
    Option& quality = options.text("--quality", "NAME", a.image.quality,
                                   "draft, final or exact, as render has them");
    quality.value = Option::Value::word;
    for (const auto& [word, meaning] : k_quality_names) quality.words.emplace_back(word);
    options.integer("--samples", "N", a.image.samples, 1, k_max_paths,
                    "samples per pixel; default: the scene's");
    add_output_options(options, a);
    options.parsed(
        "--shard", "I/N", [&a](const std::string& text) { a.shard = shard_in(text); },
        "render only part I of N of the frames; --merge completes the set");
    options.integer("--slurm", "TASKS", a.slurm_tasks, 1, 100'000,
                    "render on a cluster: write and submit a job array of this many tasks, and a "
                    "job that merges and checks");
    options
        .text("--slurm-options", "OPTIONS", a.slurm_options,
              "further options of sbatch for all jobs, such as '--partition=long --account=reef'")
        .needs = "--slurm";
    options
        .flag("--slurm-dry-run", a.slurm_dry_run,
              "measure and write the jobs, but do not submit them")
        .needs = "--slurm";
    options.output("--merge", "FOLDER", a.merge,
                   "check the set in a folder whose shards are done, and complete it");
    options.threads(a.image.threads);
    options.confine();
    options.messages(a.image.quiet, a.image.progress);
    return options;
}

namespace {

std::vector<std::optional<int>> frames_in(const DatasetArguments& a, const SceneDesc& scene) {
    std::vector<int> numbers = a.image.frames;
    if (a.image.all_frames || (numbers.empty() && has_motion(scene))) numbers = all_frames(scene);
    if (numbers.empty()) return {std::nullopt};
    std::ranges::sort(numbers);
    return {numbers.begin(), numbers.end()};
}

std::vector<std::string> cameras_in(const DatasetArguments& a, const SceneDesc& scene) {
    for (const std::string& name : a.cameras) camera_called(name, scene.cameras);
    if (scene.cameras.empty()) return {""};
    std::vector<std::string> names;
    for (const RigCameraDesc& entry : scene.cameras)
        if (a.cameras.empty() || std::ranges::find(a.cameras, entry.name) != a.cameras.end())
            names.push_back(entry.name);
    return names;
}

/// In the order of the table, and with what they bring along.
std::vector<std::string> formats_in(const DatasetArguments& a) {
    std::vector<std::string> wanted = a.formats;
    if (wanted.empty()) wanted = {"png", "depth"};
    if (std::ranges::any_of(
            wanted, [](const std::string& name) { return dataset_format(name).needs_images; }))
        wanted.emplace_back("png");
    std::vector<std::string> names;
    for (const DatasetFormat& format : dataset_formats())
        if (std::ranges::find(wanted, format.name) != wanted.end()) names.emplace_back(format.name);
    return names;
}

}  // namespace

std::string shell_word(const std::string& text) {
    constexpr const char* k_plain =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_=./,:+%@";
    if (!text.empty() && text.find_first_not_of(k_plain) == std::string::npos) return text;
    return in_shell_quotes(text);
}

std::string set_options(const DatasetArguments& a, const DatasetDefinition& d) {
    std::string text;
    const auto add = [&](const char* option, const std::string& value) {
        if (!value.empty()) text += fmt::format(" {} {}", option, shell_word(value));
    };
    add("--format", fmt::format("{}", fmt::join(d.formats, ",")));
    add("--frames", a.frames);
    if (!a.cameras.empty()) add("--cameras", fmt::format("{}", fmt::join(d.cameras, ",")));
    for (const std::string& override : a.image.overrides) add("--set", override);
    if (a.image.variation_count) add("--variations", fmt::format("{}", *a.image.variation_count));
    add("--size", d.size);
    add("--quality", d.quality);
    add("--samples", d.samples);
    add("--layers", d.layers);
    if (d.is_16_bit) add("--image-bits", "16");
    if (d.exposure) add("--exposure", fmt::format("{}", *d.exposure));
    if (a.depth_scale) add("--depth-scale", fmt::format("{}", d.depth_scale));
    if (d.depth_far) add("--depth-far", fmt::format("{}", *d.depth_far));
    if (d.pinhole_fit) text += " --pinhole-fit";
    add("--licence", d.licence);
    return text;
}

std::vector<std::vector<std::string>> draws_of(const DatasetArguments& a, bool check) {
    if (a.image.is_scene_itself()) return {{}};
    RunScenes scenes(a.image);
    std::vector<std::vector<std::string>> draws;
    for (const std::optional<int> variation : scenes.all()) {
        if (check) scenes.of(variation);
        std::vector<std::string>& values = draws.emplace_back();
        for (const DrawnValue& value : scenes.variations().values(*variation))
            values.push_back(value.override_text());
    }
    return draws;
}

DatasetDefinition definition_of(const DatasetArguments& a, const SceneDesc& scene) {
    DatasetDefinition d;
    d.program = "uwvdb " + program_version();
    d.scene = a.image.scene.filename().string();
    d.scene_hash = scene.hash;
    d.frames = frames_in(a, scene);
    d.cameras = cameras_in(a, scene);
    d.formats = formats_in(a);
    if (a.image.size) d.size = fmt::format("{}x{}", (*a.image.size)[0], (*a.image.size)[1]);
    d.quality = a.image.quality;
    if (a.image.samples) d.samples = fmt::format("{}", *a.image.samples);
    d.layers = a.image.layers;
    d.is_16_bit = a.image.preview_bits == 16;
    d.exposure = a.exposure;
    if (a.depth_scale) d.depth_scale = *a.depth_scale;
    d.depth_far = a.depth_far;
    d.pinhole_fit = a.pinhole_fit;
    d.licence = a.licence;
    if (!d.layers.empty() && !d.has_format("exr") && !d.has_format("npy"))
        throw UsageError("--layers: are those of exr and npy; add one of them to --format");
    d.command = "uwvdb dataset " + shell_word(d.scene) + set_options(a, d);
    return d;
}

SceneDesc scene_of_draw(const DatasetArguments& a, const std::vector<std::string>& overrides) {
    std::vector<std::string> all = a.image.overrides;
    all.insert(all.end(), overrides.begin(), overrides.end());
    SceneDesc scene = load_scene(a.image.scene, all);
    apply_request(a.image.image(), scene);
    return scene;
}

}  // namespace uw
