#include "cli/info/vdb_json.h"

#include "cli/info/vdb_text.h"
#include "core/base/version.h"
#include "core/json/json.h"

namespace uw {

namespace {

Json values(const ValueSummary& v) {
    Json out;
    const auto of_finite = [&](double x) { return v.finite > 0 ? number_json(x) : Json(nullptr); };
    out["min"] = of_finite(v.min);
    out["mean"] = of_finite(v.mean);
    out["max"] = of_finite(v.max);
    out["nan"] = v.nan;
    out["infinite"] = v.infinite;
    out["negative"] = v.negative;
    out["zero"] = v.zero;
    out["background"] = v.background;
    out["histogram"] = {
        {"from", of_finite(v.min)}, {"to", of_finite(v.max)}, {"counts", v.histogram}};
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
            {"missing", sequence.missing},
            {"empty", sequence.empty},
            {"sampled", sequence.sampled},
            {"largest", list_json(sequence.largest)}};
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
    out["voxel_size"] = advice.voxel_size ? Json(*advice.voxel_size) : Json(nullptr);
    out["scale"] = advice.scale;
    out["translate"] = vector_json(advice.translate);
    out["small_ppm"] = advice.small_ppm;
    out["large_ppm"] = advice.large_ppm;
    out["bands_nm"] = advice.bands_nm;
    out["optical_depth"] = advice.optical_depth;
    out["world_bounds"] = bounds_json(advice.bounds);
    const SceneProposal& view = advice.view.proposal;
    out["view"] = {{"position", point_json(view.eye)},
                   {"look_at", point_json(view.target)},
                   {"fov_x", k_proposed_fov}};
    out["lamps"] = Json::array();
    for (const ProposedLamp& lamp : view.lamps)
        out["lamps"].push_back({{"name", lamp.name},
                                {"position", point_json(lamp.position)},
                                {"direction", vector_json(lamp.direction)},
                                {"beam", lamp.beam},
                                {"intensity", lamp.intensity}});
    out["contrast"] = advice.view.draft.contrast;
    out["scene"] = advice.scene;
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
