#include "cli/info/vdb_json.h"

#include "cli/info/vdb_text.h"
#include "cli/version.h"
#include "core/json/json.h"

namespace uw {

namespace {

Json values(const ValueSummary& v) {
    Json out;
    out["min"] = number_json(v.min);
    out["mean"] = number_json(v.mean);
    out["max"] = number_json(v.max);
    out["nan"] = v.nan;
    out["infinite"] = v.infinite;
    out["negative"] = v.negative;
    out["zero"] = v.zero;
    out["background"] = v.background;
    out["histogram"] = {
        {"from", number_json(v.min)}, {"to", number_json(v.max)}, {"counts", v.histogram}};
    return out;
}

Json text_or_null(const std::string& text) {
    return text.empty() ? Json(nullptr) : Json(text);
}

Json grid_json(const GridInspection& grid) {
    const GridSummary& s = grid.summary;
    Json out;
    out["name"] = s.name;
    out["type"] = s.value_type;
    out["class"] = s.grid_class;
    out["precision"] = precision_of(s);
    out["compression"] = compression_of(s);
    out["transform"] = text_or_null(grid.transform);
    out["metres_per_voxel"] = vector_json(grid.voxel_size);
    out["active_voxels"] = grid.active_voxels ? Json(*grid.active_voxels) : Json(nullptr);
    out["world_bounds"] = bounds_json(grid.world_bounds);
    out["values"] = grid.values ? values(*grid.values) : Json(nullptr);
    out["unusable"] = text_or_null(grid.unusable);
    out["unread"] = text_or_null(grid.unread);
    return out;
}

Json sequence_json(const SequenceReport& sequence) {
    if (sequence.pattern.empty()) return nullptr;
    return {{"pattern", sequence.pattern},
            {"frame", sequence.frame},
            {"found", sequence.found},
            {"missing", sequence.missing}};
}

Json advice_json(const VdbReport& report) {
    const VdbAdvice& advice = report.advice;
    const Placement& p = report.inspection.placement;
    Json out;
    out["lines"] = advice.lines;
    out["map"] = advice.map;
    out["up"] = p.up == UpAxis::z ? "z" : "y";
    out["centering"] = p.centering == Centering::cell ? "cell" : "node";
    out["volumes"] = text_or_null(advice.volumes);
    if (advice.map.empty()) return out;
    out["scale"] = advice.scale;
    out["small_ppm"] = advice.small_ppm;
    out["large_ppm"] = advice.large_ppm;
    out["bands_nm"] = advice.bands_nm;
    out["optical_depth"] = advice.optical_depth;
    out["world_bounds"] = bounds_json(advice.bounds);
    out["view"] = {{"position", point_json(advice.eye)}, {"look_at", point_json(advice.target)}};
    return out;
}

}  // namespace

std::string vdb_json(const VdbReport& report) {
    const VdbHeader& header = report.inspection.header;
    Json json;
    json["uwvdb"] = program_version();
    json["file"] = report.file;
    json["sequence"] = sequence_json(report.sequence);
    json["format"] = header.is_nano ? "nvdb" : "vdb";
    json["version"] = header.is_nano ? Json(nullptr) : Json(header.version);
    json["library"] =
        std::to_string(header.library_major) + "." + std::to_string(header.library_minor);
    json["creator"] = text_or_null(header.creator);
    json["grids"] = Json::array();
    for (const GridInspection& grid : report.inspection.grids)
        json["grids"].push_back(grid_json(grid));
    json["advice"] = advice_json(report);
    return json_text(json);
}

}  // namespace uw
