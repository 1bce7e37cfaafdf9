#include "cli/dataset/set_definition.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "cli/camera_choice.h"
#include "cli/render/frame_sequence.h"
#include "cli/render/run_scenes.h"
#include "core/base/error.h"
#include "core/base/version.h"
#include "dataset/formats/format_table.h"
#include "render/scene_loading.h"
#include "render/scene_motion.h"

namespace uw {

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
    std::string word = "'";
    for (const char c : text) word += c == '\'' ? "'\\''" : std::string(1, c);
    return word + "'";
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
    d.is_16_bit = a.image.is_preview_16_bit;
    d.exposure = a.exposure;
    if (a.depth_scale) d.depth_scale = *a.depth_scale;
    d.depth_far = a.depth_far;
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
