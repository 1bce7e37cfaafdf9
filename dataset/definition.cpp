#include "dataset/definition.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <fstream>
#include <system_error>

#include "core/base/error.h"
#include "core/base/input_files.h"
#include "core/base/text.h"

namespace uw {

namespace {

/// Numbers as "0-48,60": runs of consecutive ones.
std::string frames_text(const std::vector<std::optional<int>>& frames) {
    std::string text;
    for (std::size_t i = 0; i < frames.size();) {
        std::size_t end = i + 1;
        while (end < frames.size() && frames[end] && frames[i] &&
               *frames[end] == *frames[i] + static_cast<int>(end - i))
            ++end;
        if (!frames[i]) return "none";
        if (i > 0) text += ",";
        text += fmt::format("{}", *frames[i]);
        if (end - i > 1) text += fmt::format("-{}", *frames[end - 1]);
        i = end;
    }
    return text;
}

Json optional_json(const std::optional<double>& value) {
    return value ? Json(*value) : Json(nullptr);
}

/// The name of a key's values in messages about a difference.
std::string shown(const Json& value) {
    constexpr std::size_t k_longest = 60;
    const std::string text = value.is_string() ? value.get<std::string>() : value.dump();
    return text.empty() ? "not given" : printable(text, k_longest);
}

}  // namespace

View DatasetDefinition::view(std::size_t index) const {
    const std::size_t moment = index / cameras.size();
    return {moment / frames.size(), moment % frames.size(), index % cameras.size()};
}

std::size_t DatasetDefinition::index(const View& view) const {
    return (view.draw * frames.size() + view.frame) * cameras.size() + view.camera;
}

std::optional<std::size_t> DatasetDefinition::place_of_frame(int number) const {
    const auto found = std::ranges::find(frames, std::optional(number));
    if (found == frames.end()) return std::nullopt;
    return static_cast<std::size_t>(found - frames.begin());
}

bool DatasetDefinition::has_format(std::string_view name) const {
    return std::ranges::find(formats, name) != formats.end();
}

std::string DatasetDefinition::folder(std::size_t draw) const {
    return draws.size() == 1 ? "" : fmt::format("draw_{:05}/", draw);
}

std::string DatasetDefinition::stem(const View& view) const {
    const std::string number = fmt::format("{:06}", frames[view.frame].value_or(0));
    return has_rig() ? cameras[view.camera] + "/" + number : number;
}

std::string DatasetDefinition::file(const View& view, std::string_view kind,
                                    std::string_view ending) const {
    return fmt::format("{}{}/{}{}", folder(view.draw), kind, stem(view), ending);
}

ViewRange shard_of(const DatasetDefinition& definition, std::size_t number, std::size_t count) {
    const std::size_t moments = definition.draws.size() * definition.frames.size();
    const auto begin = [&](std::size_t shard) {
        return moments * shard / count * definition.cameras.size();
    };
    return {begin(number - 1), begin(number)};
}

Json definition_json(const DatasetDefinition& d) {
    Json frames = Json::array();
    for (const std::optional<int>& frame : d.frames)
        frames.push_back(frame ? Json(*frame) : Json(nullptr));
    return {{"program", d.program},
            {"command", d.command},
            {"scene", d.scene},
            {"scene_hash", d.scene_hash},
            {"draws", d.draws},
            {"frames", frames},
            {"cameras", d.cameras},
            {"formats", d.formats},
            {"size", d.size},
            {"quality", d.quality},
            {"samples", d.samples},
            {"layers", d.layers},
            {"image_bits", d.is_16_bit ? 16 : 8},
            {"exposure", optional_json(d.exposure)},
            {"depth_scale", d.depth_scale},
            {"depth_far", optional_json(d.depth_far)},
            {"pinhole_fit", d.pinhole_fit},
            {"licence", d.licence}};
}

DatasetDefinition definition_from_json(const Json& json, const std::string& subject) {
    try {
        DatasetDefinition d;
        const auto optional = [&](const char* key, auto& value) {
            if (!json.at(key).is_null())
                value = json.at(key).get<typename std::decay_t<decltype(value)>::value_type>();
        };
        json.at("program").get_to(d.program);
        json.at("command").get_to(d.command);
        json.at("scene").get_to(d.scene);
        json.at("scene_hash").get_to(d.scene_hash);
        json.at("draws").get_to(d.draws);
        d.frames.clear();
        for (const Json& frame : json.at("frames"))
            d.frames.push_back(frame.is_null() ? std::nullopt : std::optional(frame.get<int>()));
        json.at("cameras").get_to(d.cameras);
        json.at("formats").get_to(d.formats);
        json.at("size").get_to(d.size);
        json.at("quality").get_to(d.quality);
        json.at("samples").get_to(d.samples);
        json.at("layers").get_to(d.layers);
        d.is_16_bit = json.at("image_bits").get<int>() == 16;
        optional("exposure", d.exposure);
        json.at("depth_scale").get_to(d.depth_scale);
        optional("depth_far", d.depth_far);
        json.at("pinhole_fit").get_to(d.pinhole_fit);
        json.at("licence").get_to(d.licence);
        if (d.draws.empty() || d.frames.empty() || d.cameras.empty())
            throw InputError(subject + ": it has no views");
        return d;
    } catch (const Json::exception& error) {
        throw InputError(fmt::format("{}: is not the description of a data set: {}", subject,
                                     printable(error.what(), 200)));
    }
}

std::string difference(const DatasetDefinition& there, const DatasetDefinition& here) {
    if (there.frames != here.frames)
        return fmt::format("its frames are {} there, {} here",
                           printable(frames_text(there.frames), 60),
                           printable(frames_text(here.frames), 60));
    const Json a = definition_json(there), b = definition_json(here);
    for (const auto& [key, value] : a.items())
        if (key != "command" && value != b.at(key))
            return fmt::format("its {} is {} there, {} here", key, shown(value), shown(b.at(key)));
    return {};
}

namespace {

namespace fs = std::filesystem;

constexpr int k_dataset_version = 3;

/// Whether the folder contains anything but temporary files of killed processes.
bool has_files(const fs::path& folder) {
    std::error_code error;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, error))
        if (!entry.path().filename().string().starts_with(".uwvdb-")) return true;
    return false;
}

}  // namespace

std::string dataset_text(const DatasetFile& file) {
    return json_text({{"uwvdb_dataset", k_dataset_version},
                      {"set", definition_json(file.definition)},
                      {"exposure", file.exposures.image},
                      {"clean_exposure", file.exposures.clean},
                      {"facts", file.facts}});
}

std::optional<DatasetFile> read_dataset_file(const fs::path& folder) {
    const fs::path name = folder / k_dataset_file;
    const std::string shown = printable(name.string(), 300);
    std::ifstream in = open_own_file(name);
    if (!in) {
        if (has_files(folder))
            throw UsageError(fmt::format(
                "-o {}: the folder has other files, and no data set to continue; give an empty one",
                printable(folder.string(), 300)));
        return std::nullopt;
    }
    try {
        const Json json = Json::parse(in);
        if (json.at("uwvdb_dataset") != k_dataset_version)
            throw InputError(shown + ": is of another version of uwvdb; give another folder");
        return DatasetFile{
            definition_from_json(json.at("set"), shown),
            {json.at("exposure").get<double>(), json.at("clean_exposure").get<double>()},
            json.at("facts")};
    } catch (const Json::exception& error) {
        throw InputError(fmt::format("{}: is not the description of a data set: {}", shown,
                                     printable(error.what(), 200)));
    }
}

void check_same_set(const fs::path& folder, const DatasetDefinition& there,
                    const DatasetDefinition& wanted) {
    const std::string what = difference(there, wanted);
    if (!what.empty())
        throw UsageError(fmt::format(
            "-o {}: holds another data set: {}; give the same options to continue it, or another "
            "folder",
            printable(folder.string(), 300), what));
}

}  // namespace uw
