#include "cli/dataset/dataset_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "cli/frame_list.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "core/scene/render_desc.h"
#include "dataset/formats/format_table.h"

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

constexpr std::size_t k_most_shards = 1'000'000;

ShardArgument shard_in(const std::string& text) {
    ShardArgument shard;
    const char* const end = text.data() + text.size();
    const auto [slash, fault] = std::from_chars(text.data(), end, shard.number);
    if (fault == std::errc() && slash != end && *slash == '/') {
        const auto [last, error] = std::from_chars(slash + 1, end, shard.count);
        if (error == std::errc() && last == end && shard.number >= 1 &&
            shard.number <= shard.count && shard.count <= k_most_shards)
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
        "of the images of a camera without sensor; auto: one that suits all views");
    Option& bits = options.parsed(
        "--image-bits", "N",
        [&a](const std::string& text) {
            if (text != "8" && text != "16")
                throw UsageError(
                    fmt::format("--image-bits: expected 8 or 16, found '{}'", printable(text)));
            a.image.is_preview_16_bit = text == "16";
        },
        "of the same images: 8, the default, or 16");
    bits.value = Option::Value::word;
    bits.words = {"8", "16"};
    options.number("--depth-scale", "N", a.depth_scale, 0, 1e9,
                   "of 16-bit depth: N per metre; default 1000");
    options.number("--depth-far", "D", a.depth_far, 0, 1e9,
                   "leave out of 16-bit depth what is farther than D metres");
    options.text("--licence", "TEXT", a.licence, "of the set, for its data card");
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
    options.path("SCENE", "", a.image.scene, "scene file (docs/scene-file.md)");
    options.path("-o,--output", "FOLDER", a.image.output,
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
    options.integer("--samples", "N", a.image.samples, 1, k_most_paths,
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
    options.path("--merge", "FOLDER", a.merge,
                 "check the set in a folder whose shards are done, and complete it");
    options.threads(a.image.threads);
    options.confine();
    options.flag("--quiet", a.image.quiet, "print nothing but warnings and errors");
    return options;
}

}  // namespace uw
