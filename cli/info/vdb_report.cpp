#include "cli/info/vdb_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cli/grid_summary.h"
#include "cli/image_choice.h"
#include "core/base/json.h"
#include "core/base/version.h"

namespace uw {

namespace {

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
        const double fraction =
            std::log1p(static_cast<double>(count)) / std::log1p(static_cast<double>(most));
        const auto shade =
            static_cast<std::size_t>(fraction * static_cast<double>(k_shades.size()));
        bars += k_shades[std::min(shade, k_shades.size() - 1)];
    }
    return bars;
}

Json text_or_null(const std::string& text) {
    return text.empty() ? Json(nullptr) : Json(text);
}

/// "none", "zip", "blosc, active values only" and so on.
std::string compression_of(const GridSummary& grid) {
    std::string text;
    if ((grid.compression & 1U) != 0) text = "zip";
    if ((grid.compression & 4U) != 0) text = "blosc";
    if (text.empty()) text = "none";
    if ((grid.compression & 2U) != 0) text += ", active values only";
    return text;
}

/// How many bits its numbers have in the file: "half", "float", "fp8" and so on.
std::string precision_of(const GridSummary& grid) {
    if (!grid.quantised.empty()) return grid.quantised;
    return grid.half ? "half" : grid.value_type;
}

Report report_on_values(const ValueSummary& v, bool are_lengths) {
    Report report;
    const bool any = v.finite > 0;
    const auto of_finite = [&](double x) { return any ? number_json(x) : Json(nullptr); };
    if (any)
        report.say(fmt::format("{}: min {:.4g}, mean {:.4g}, max {:.4g}",
                               are_lengths ? "lengths" : "values", v.min, v.mean, v.max));
    if (any && v.max > v.min)
        report.say(fmt::format("histogram, by the logarithm of the count: {:.4g} |{}| {:.4g}",
                               v.min, histogram(v), v.max));
    report.say(fmt::format("background {}; NaN {}, infinite {}, negative {}, zero {}", v.background,
                           v.nan, v.infinite, v.negative, v.zero));
    report.set({{"min", of_finite(v.min)},
                {"mean", of_finite(v.mean)},
                {"max", of_finite(v.max)},
                {"nan", v.nan},
                {"infinite", v.infinite},
                {"negative", v.negative},
                {"zero", v.zero},
                {"background", v.background},
                {"histogram",
                 {{"from", of_finite(v.min)}, {"to", of_finite(v.max)}, {"counts", v.histogram}}}});
    return report;
}

Report report_on_grid(const GridInspection& grid) {
    const GridSummary& s = grid.summary;
    Report report(fmt::format("\ngrid '{}': {}, {}, saved as {}, compression {}", s.name,
                              s.value_type, s.grid_class == "unknown" ? "no class" : s.grid_class,
                              precision_of(s), compression_of(s)));
    report.set({{"name", s.name},
                {"type", s.value_type},
                {"class", s.grid_class},
                {"precision", precision_of(s)},
                {"compression", compression_of(s)}});
    const Vector3& h = grid.voxel_size;
    if (!grid.transform.empty())
        report.say(fmt::format("{:.4g} x {:.4g} x {:.4g} m per voxel, transform: {}", h.x, h.y, h.z,
                               grid.transform));
    if (grid.active_voxels) report.say(fmt::format("{} active voxels", *grid.active_voxels));
    if (!grid.world_bounds.empty()) report.say("world bounds " + bounds_text(grid.world_bounds));
    report.set({{"transform", text_or_null(grid.transform)},
                {"metres_per_voxel", vector_json(h)},
                {"active_voxels", grid.active_voxels ? Json(*grid.active_voxels) : Json(nullptr)},
                {"world_bounds", bounds_json(grid.world_bounds)}});
    if (grid.values)
        report.add("values", report_on_values(*grid.values, s.value_type.starts_with("vec")));
    else
        report.set({{"values", nullptr}});
    if (!grid.unread.empty()) report.say("values not read: " + grid.unread);
    report.set({{"unusable", text_or_null(grid.unusable)}, {"unread", text_or_null(grid.unread)}});
    return report;
}

Report report_on_frames(const SequenceReport& sequence) {
    Report report;
    report.say(fmt::format("sequence {}: {} {} there: {}", sequence.pattern, sequence.found.size(),
                           sequence.found.size() == 1 ? "frame is" : "frames are",
                           format_frame_list(sequence.found)));
    if (!sequence.missing.empty())
        report.say("missing between them: " + format_frame_list(sequence.missing));
    if (!sequence.empty.empty())
        report.say("frames that hold nothing to map: " + format_frame_list(sequence.empty));
    report.set({{"pattern", sequence.pattern},
                {"frame", sequence.frame},
                {"found", sequence.found},
                {"missing", sequence.missing},
                {"empty", sequence.empty},
                {"sampled", sequence.sampled},
                {"largest", list_json(sequence.largest)}});
    report.say(fmt::format("frame {}:", sequence.frame));
    return report;
}

Report report_on_advice(const VdbSurvey& survey) {
    Report report;
    const VdbAdvice& advice = survey.advice;
    const Placement& p = survey.inspection.placement;
    report.say("\nAdvice");
    for (const std::string& line : advice.lines) report.say("- " + line);
    report.set({{"lines", advice.lines},
                {"map", advice.map},
                {"up", name_of_up(p.up)},
                {"centering", p.centering == Centering::cell ? "cell" : "node"},
                {"volumes", text_or_null(advice.volumes)}});
    if (advice.map.empty()) return report;
    const SceneProposal& view = advice.view.proposal;
    report.set({{"voxel_size", advice.voxel_size ? Json(*advice.voxel_size) : Json(nullptr)},
                {"scale", advice.scale},
                {"mirror", vector_json(advice.mirror)},
                {"level_set", advice.level_sets == LevelSets::fog ? Json("fog") : Json(nullptr)},
                {"rotate", vector_json(advice.rotate)},
                {"fps", advice.fps ? Json(*advice.fps) : Json(nullptr)},
                {"translate", vector_json(advice.translate)},
                {"small_ppm", advice.small_ppm},
                {"large_ppm", advice.large_ppm},
                {"bands_nm", advice.bands_nm},
                {"optical_depth", advice.optical_depth},
                {"world_bounds", bounds_json(advice.bounds)},
                {"view",
                 {{"position", point_json(view.eye)},
                  {"look_at", point_json(view.target)},
                  {"fov_x", k_proposed_fov}}}});
    Json lamps = Json::array();
    for (const ProposedLamp& lamp : view.lamps)
        lamps.push_back({{"name", lamp.name},
                         {"position", point_json(lamp.position)},
                         {"direction", vector_json(lamp.direction)},
                         {"beam", lamp.beam},
                         {"intensity", lamp.intensity}});
    report.say(
        "\nA scene that shows it, as --scene prints it alone; or paste its parts into your "
        "own:\n\n" +
        advice.scene);
    report.set({{"lamps", std::move(lamps)},
                {"contrast", advice.view.draft.contrast},
                {"median_contrast", advice.view.draft.median_contrast},
                {"scene", advice.scene}});
    return report;
}

}  // namespace

Report report_on_vdb(const VdbSurvey& survey) {
    const VdbHeader& header = survey.inspection.header;
    Report report;
    report.set({{"uwvdb", program_version()}, {"file", survey.file}});
    if (survey.sequence.pattern.empty())
        report.set({{"sequence", nullptr}});
    else
        report.add("sequence", report_on_frames(survey.sequence));
    const std::string library = fmt::format("{}.{}", header.library_major, header.library_minor);
    report.say(fmt::format(
        "{}: {}", header.file.filename().string(),
        header.is_nano
            ? "NanoVDB, library " + library
            : fmt::format("VDB version {}, library {}, creator {}", header.version, library,
                          header.creator.empty() ? "not named" : "'" + header.creator + "'")));
    report.set({{"format", header.is_nano ? "nvdb" : "vdb"},
                {"version", header.is_nano ? Json(nullptr) : Json(header.version)},
                {"library", library},
                {"creator", text_or_null(header.creator)}});
    if (header.grids.empty()) report.say("no grids");
    std::vector<Report> grids;
    for (const GridInspection& grid : survey.inspection.grids)
        grids.push_back(report_on_grid(grid));
    report.add("grids", grids);
    report.add("advice", report_on_advice(survey));
    return report;
}

}  // namespace uw
