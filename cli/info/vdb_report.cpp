#include "cli/info/vdb_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cli/image_choice.h"
#include "core/base/json.h"
#include "core/base/version.h"

namespace uw {

namespace {

std::string describe_bounds(const Bounds& b) {
    return fmt::format("x {:.4g}..{:.4g}, y {:.4g}..{:.4g}, z {:.4g}..{:.4g} m", b.min.x, b.max.x,
                       b.min.y, b.max.y, b.min.z, b.max.z);
}

/// One character per bin, by the logarithm of its count: a blank for none, then . to @.
std::string histogram(const ValueSummary& values) {
    constexpr std::string_view k_shades = ".:-=+*#%@";
    const std::int64_t most = *std::ranges::max_element(values.histogram);
    std::string bars;
    for (const std::int64_t count : values.histogram) {
        if (count == 0) {
            bars += ' ';
            continue;
        }
        const double share =
            std::log1p(static_cast<double>(count)) / std::log1p(static_cast<double>(most));
        const auto shade = static_cast<std::size_t>(share * static_cast<double>(k_shades.size()));
        bars += k_shades[std::min(shade, k_shades.size() - 1)];
    }
    return bars;
}

std::string describe_values(const ValueSummary& v, bool lengths) {
    std::string text;
    if (v.finite > 0)
        text += fmt::format("  {}: min {:.4g}, mean {:.4g}, max {:.4g}\n",
                            lengths ? "lengths" : "values", v.min, v.mean, v.max);
    if (v.finite > 0 && v.max > v.min)
        text += fmt::format("  histogram, by the logarithm of the count: {:.4g} |{}| {:.4g}\n",
                            v.min, histogram(v), v.max);
    text += fmt::format("  background {}; NaN {}, infinite {}, negative {}, zero {}\n",
                        v.background, v.nan, v.infinite, v.negative, v.zero);
    return text;
}

std::string describe_grid(const GridInspection& grid) {
    const GridSummary& s = grid.summary;
    std::string text = fmt::format(
        "\ngrid '{}': {}, {}, saved as {}, compression {}\n", s.name, s.value_type,
        s.grid_class == "unknown" ? "no class" : s.grid_class, precision_of(s), compression_of(s));
    const Vector3& h = grid.voxel_size;
    if (!grid.transform.empty())
        text += fmt::format("  {:.4g} x {:.4g} x {:.4g} m per voxel, transform: {}\n", h.x, h.y,
                            h.z, grid.transform);
    if (grid.active_voxels) text += fmt::format("  {} active voxels\n", *grid.active_voxels);
    if (!grid.world_bounds.empty())
        text += "  world bounds " + describe_bounds(grid.world_bounds) + "\n";
    if (grid.values) text += describe_values(*grid.values, s.value_type.starts_with("vec"));
    if (!grid.unread.empty()) text += "  values not read: " + grid.unread + "\n";
    return text;
}

std::string describe_sequence(const SequenceReport& sequence) {
    if (sequence.pattern.empty()) return "";
    std::string text = fmt::format(
        "sequence {}: {} {} there: {}\n", sequence.pattern, sequence.found.size(),
        sequence.found.size() == 1 ? "frame is" : "frames are", format_frame_list(sequence.found));
    if (!sequence.missing.empty())
        text += "missing between them: " + format_frame_list(sequence.missing) + "\n";
    if (!sequence.empty.empty())
        text += "frames that hold nothing to map: " + format_frame_list(sequence.empty) + "\n";
    return text + fmt::format("frame {}:\n", sequence.frame);
}

}  // namespace

std::string compression_of(const GridSummary& grid) {
    std::string text;
    if ((grid.compression & 1U) != 0) text = "zip";
    if ((grid.compression & 4U) != 0) text = "blosc";
    if (text.empty()) text = "none";
    if ((grid.compression & 2U) != 0) text += ", active values only";
    return text;
}

std::string precision_of(const GridSummary& grid) {
    if (!grid.quantised.empty()) return grid.quantised;
    return grid.half ? "half" : grid.value_type;
}

std::string vdb_text(const VdbReport& report) {
    const VdbHeader& header = report.inspection.header;
    std::string text = describe_sequence(report.sequence);
    const std::string file = header.file.filename().string();
    if (header.is_nano)
        text += fmt::format("{}: NanoVDB, library {}.{}\n", file, header.library_major,
                            header.library_minor);
    else
        text += fmt::format("{}: VDB version {}, library {}.{}, creator {}\n", file, header.version,
                            header.library_major, header.library_minor,
                            header.creator.empty() ? "not named" : "'" + header.creator + "'");
    if (header.grids.empty()) text += "no grids\n";
    for (const GridInspection& grid : report.inspection.grids) text += describe_grid(grid);
    text += "\nAdvice\n";
    const VdbAdvice& advice = report.advice;
    for (const std::string& line : advice.lines) text += "- " + line + "\n";
    if (advice.volumes.empty()) return text;
    text +=
        "\nA scene that shows it, as --scene prints it alone; or paste its parts into your "
        "own:\n\n";
    return text + advice.scene;
}

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
