#include "cli/render/run_scenes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

#include "cli/console.h"
#include "core/base/csv_table.h"
#include "core/base/error.h"
#include "core/base/input_files.h"
#include "core/base/json.h"
#include "core/base/text.h"
#include "core/base/version.h"
#include "core/scene/yaml_document.h"
#include "render/scene_loading.h"

namespace uw {

RunScenes::RunScenes(const RenderArguments& arguments)
    : arguments_(arguments), job_([this](int number) {
          SceneDesc scene = variations_ ? variations_->scene(number)
                                        : load_scene(arguments_.scene, arguments_.overrides);
          apply_request(arguments_.image(), scene);
          return scene;
      }) {
    if (arguments.is_scene_itself()) {
        all_.emplace_back();
        return;
    }
    variations_.emplace(arguments.scene, arguments.overrides);
    if (!variations_->desc())
        throw UsageError(
            fmt::format("--variation{}: the scene has none; add a section such as "
                        "variations: {{keys: {{lamps[0].power: {{uniform: [10, 30]}}}}}}",
                        arguments.variation_count ? "s" : ""));
    if (!arguments.variation_count) {
        all_.assign(arguments.variations.begin(), arguments.variations.end());
        return;
    }
    for (int i = 0; i < *arguments.variation_count; ++i) all_.emplace_back(i);
    for (const int wanted : arguments.variations)
        if (wanted >= *arguments.variation_count)
            throw UsageError(fmt::format("--variation {}: there are --variations {}, from 0 to {}",
                                         wanted, *arguments.variation_count,
                                         *arguments.variation_count - 1));
}

bool RunScenes::is_wanted(std::optional<int> variation) const {
    const std::vector<int>& wanted = arguments_.variations;
    return !variation || wanted.empty() || std::ranges::find(wanted, *variation) != wanted.end();
}

namespace {

namespace fs = std::filesystem;

// The folder of all images: that of their name, up to the part that varies.
fs::path common_folder(const fs::path& name) {
    fs::path folder;
    for (const fs::path& part : name.parent_path()) {
        const std::string text = part.string();
        if (text.find('{') != std::string::npos || has_frame_pattern(text)) break;
        folder /= part;
    }
    return folder;
}

Json value_json(const ConfigNode& value) {
    double number = 0;
    switch (value.kind) {
        case ConfigNode::Kind::null:
            return nullptr;
        case ConfigNode::Kind::scalar:
            if (value.quoted) return value.scalar;
            if (value.scalar == "true" || value.scalar == "false") return value.scalar == "true";
            if (parse_number(value.scalar, number) != NumberText::number) return value.scalar;
            if (number == std::floor(number) && std::abs(number) < 1e15)
                return static_cast<std::int64_t>(number);
            return number;
        case ConfigNode::Kind::sequence: {
            Json list = Json::array();
            for (const ConfigNode& item : value.items) list.push_back(value_json(item));
            return list;
        }
        case ConfigNode::Kind::map:
            break;
    }
    Json map = Json::object();
    for (const ConfigNode::Entry& entry : value.entries) map[entry.key] = value_json(entry.value);
    return map;
}

}  // namespace

VariationManifest::VariationManifest(const RenderArguments& arguments) : arguments_(arguments) {
    if (!arguments.variation_count) return;
    const fs::path stem = common_folder(output_files(arguments).main()) / arguments.scene.stem();
    csv_file_ = stem.string() + ".variations.csv";
    json_file_ = stem.string() + ".variations.json";
}

void VariationManifest::add(int variation, const VariationsDesc& variations, std::string hash,
                            const FrameSequence& images) {
    if (csv_file_.empty()) return;
    seed_ = variations.seed;
    Entry entry{variation, draw(variations, variation), std::move(hash), {}};
    const fs::path folder = csv_file_.parent_path();
    for (const Frame& frame : images.frames)
        entry.images.push_back({frame.files.main().lexically_relative(folder).generic_string(),
                                frame.number, frame.camera_name});
    entries_.push_back(std::move(entry));
}

void VariationManifest::name_files(FrameSequence& sequence) const {
    sequence.manifest_csv = csv_file_;
    sequence.manifest_json = json_file_;
}

std::string VariationManifest::csv() const {
    std::string text = "image,variation,frame,camera,scene_hash";
    for (const DrawnValue& value : entries_.front().values) text += "," + csv_text(value.key);
    text += "\n";
    for (const Entry& entry : entries_)
        for (const Image& image : entry.images) {
            text += fmt::format("{},{},{},{},{}", csv_text(image.file), entry.variation,
                                image.frame ? fmt::format("{}", *image.frame) : "",
                                csv_text(image.camera), entry.hash);
            for (const DrawnValue& value : entry.values) text += "," + csv_text(value.text);
            text += "\n";
        }
    return text;
}

std::string VariationManifest::json() const {
    Json json;
    json["uwvdb"] = program_version();
    json["scene"] = arguments_.scene.filename().string();
    json["seed"] = seed_;
    json["set"] = arguments_.overrides;
    Json& variations = json["variations"] = Json::array();
    for (const Entry& entry : entries_) {
        Json& of_one = variations.emplace_back();
        of_one["variation"] = entry.variation;
        of_one["scene_hash"] = entry.hash;
        of_one["values"] = Json::object();
        of_one["set"] = Json::array();
        for (const DrawnValue& value : entry.values) {
            of_one["values"][value.key] = value_json(parse_yaml_value(value.text, value.key));
            of_one["set"].push_back(value.override_text());
        }
        for (const Image& image : entry.images) {
            Json& of_image = of_one["images"].emplace_back();
            of_image["file"] = image.file;
            if (image.frame) of_image["frame"] = *image.frame;
            if (!image.camera.empty()) of_image["camera"] = image.camera;
        }
    }
    return json_text(json);
}

void VariationManifest::write(bool quiet) const {
    if (csv_file_.empty()) return;
    TextFiles files;
    files.add(csv_file_, csv());
    files.add(json_file_, json());
    files.commit(quiet);
}

}  // namespace uw
