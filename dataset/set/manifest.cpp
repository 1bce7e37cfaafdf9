#include "dataset/set/manifest.h"

#include <fmt/format.h>

#include "core/motion/pose.h"
#include "core/tables/csv_cells.h"

namespace uw {

Manifest::Manifest(const DatasetDefinition& definition)
    : definition_(definition),
      csv_("view,draw,frame,time_s,camera,tx,ty,tz,qx,qy,qz,qw,record,image") {
    for (const std::string& drawn : definition.draws.front())
        csv_ += "," + csv_text(drawn.substr(0, drawn.find('=')));
    csv_ += "\n";
}

void Manifest::add(const ViewRecord& record) {
    const View& view = record.view;
    const auto [p, q] = pose_of(record.camera.world_from_camera);
    const std::optional<int> frame = definition_.frames[view.frame];
    const std::string name = record_file(definition_, view);
    const SetFile* const image = record.file("image");
    csv_ += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{}", definition_.index(view),
                        view.draw, frame ? std::to_string(*frame) : "", record.time,
                        definition_.cameras[view.camera], p.x, p.y, p.z, q.x, q.y, q.z, q.w, name,
                        image ? image->path : "");
    for (const std::string& drawn : definition_.draws[view.draw])
        csv_ += "," + csv_text(std::string_view(drawn).substr(drawn.find('=') + 1));
    csv_ += "\n";
    Json files = Json::object();
    for (const SetFile& file : record.files) files[file.role] = file.path;
    const Json json{{"view", definition_.index(view)},
                    {"draw", view.draw},
                    {"frame", frame ? Json(*frame) : Json(nullptr)},
                    {"time_s", record.time},
                    {"camera", definition_.cameras[view.camera]},
                    {"position", point_json(p)},
                    {"rotation_wxyz", {q.w, q.x, q.y, q.z}},
                    {"record", name},
                    {"files", files}};
    views_ += (views_.empty() ? "" : ",\n") + json.dump();
}

std::string Manifest::json() const {
    return fmt::format("{{\"draws\": {},\n\"views\": [\n{}\n]}}\n", Json(definition_.draws).dump(),
                       views_);
}

}  // namespace uw
