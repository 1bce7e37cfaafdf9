#include "dataset/view_record.h"

#include <algorithm>
#include <fstream>
#include <iterator>

#include "dataset/camera_json.h"
#include "dataset/sha256.h"

namespace uw {

const SetFile* ViewRecord::file(std::string_view role) const {
    const auto found = std::ranges::find(files, role, &SetFile::role);
    return found == files.end() ? nullptr : &*found;
}

std::string sum_of(const DatasetDefinition& definition) {
    return sha256_of(definition_json(definition).dump());
}

std::string record_file(const DatasetDefinition& definition, const View& view) {
    return definition.file(view, "views", ".json");
}

std::string record_text(const ViewRecord& record) {
    Json files = Json::array();
    for (const SetFile& file : record.files) files.push_back(set_file_json(file));
    const View& v = record.view;
    return json_text({{"set", record.set},
                      {"draw", v.draw},
                      {"frame", v.frame},
                      {"camera", v.camera},
                      {"time", record.time},
                      {"view", camera_json(record.camera)},
                      {"files", files}});
}

std::optional<ViewRecord> read_record(const std::filesystem::path& folder,
                                      const DatasetDefinition& definition, const std::string& sum,
                                      const View& view) {
    std::ifstream in(folder / record_file(definition, view), std::ios::binary);
    if (!in) return std::nullopt;
    try {
        const Json json = Json::parse(in);
        ViewRecord record;
        json.at("set").get_to(record.set);
        record.view = {json.at("draw").get<std::size_t>(), json.at("frame").get<std::size_t>(),
                       json.at("camera").get<std::size_t>()};
        json.at("time").get_to(record.time);
        record.camera = camera_from_json(json.at("view"));
        for (const Json& file : json.at("files")) record.files.push_back(set_file_from_json(file));
        if (record.set != sum || record.view != view) return std::nullopt;
        return record;
    } catch (const Json::exception&) {
        return std::nullopt;
    }
}

}  // namespace uw
