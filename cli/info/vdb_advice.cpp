#include "cli/info/vdb_advice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>

#include "cli/info/grid_choice.h"
#include "cli/info/placement_advice.h"
#include "cli/info/vdb_concentration.h"
#include "core/base/text.h"
#include "media/volumes/adaptive_domain.h"

namespace uw {

namespace {

std::string quoted(const std::string& text) {
    const bool plain = !text.empty() && std::ranges::all_of(text, [](unsigned char c) {
        return std::isalnum(c) != 0 || c == '_';
    }) && std::isalpha(static_cast<unsigned char>(text[0])) != 0;
    if (plain && lower_case(text) != "null" && lower_case(text) != "true" &&
        lower_case(text) != "false")
        return text;
    std::string result = "'";
    for (const char c : text) result += c == '\'' ? "''" : std::string(1, c);
    return result + "'";
}

/// What the mapped grids hold, in the file's size and place but for those that are known to be
/// wrong.
Bounds held_by(const VdbInspection& inspection, const VdbAdvice& advice) {
    const auto domain = find_adaptive_domain(inspection.header);
    const std::optional<double> voxel =
        advice.voxel_size || !domain ? advice.voxel_size : domain->voxel;
    const Affine upright = upright_from_file(inspection.placement.up);
    Bounds bounds;
    for (const GridInspection& grid : inspection.grids) {
        if (std::ranges::count(advice.map, grid.summary.name) == 0) continue;
        if (grid.world_bounds.empty()) continue;
        const double edge = grid.voxel_size.x;
        const double factor = voxel ? *voxel / edge : 1;
        const Vector3 moved = domain ? upright.apply_to_vector(edge * domain->first) : Vector3(0);
        for (const Point3& corner : {grid.world_bounds.min, grid.world_bounds.max})
            bounds.extend(at_origin_plus(factor * (from_origin(corner) + moved)));
    }
    return bounds;
}

/// How much the likeliest grid holds: the sum of its values.
double content_of(const VdbInspection& inspection) {
    const GridInspection* const grid = likeliest_grid(inspection);
    return grid->values->mean * static_cast<double>(grid->values->finite);
}

void write_block(const VdbInspection& inspection, const std::filesystem::path& file,
                 VdbAdvice& advice) {
    std::string& yaml = advice.volumes;
    yaml = "volumes:\n";
    yaml += fmt::format("  - file: {}\n    grids:\n", quoted(file.string()));
    for (const std::string& name : advice.map)
        yaml += fmt::format("      {}: {{small: {:g}, large: {:g}}}    # ppm per unit\n",
                            quoted(name), advice.small_ppm, advice.large_ppm);
    const Placement& p = inspection.placement;
    yaml += fmt::format("    centering: {}\n    up: {}\n",
                        p.centering == Centering::cell ? "cell" : "node",
                        p.up == UpAxis::z ? "z" : "y");
    if (advice.voxel_size)
        yaml +=
            fmt::format("    voxel_size: {:g}    # at most: see the advice\n", *advice.voxel_size);
    const Vector3& t = advice.translate;
    yaml += fmt::format("    transform: {{scale: {:g}, translate: [{:.15g}, {:.15g}, {:.15g}]}}\n",
                        advice.scale, t.x, t.y, t.z);
}

void write_scene(const std::filesystem::path& file, bool is_sequence, VdbAdvice& advice) {
    const std::string name = printable(file.string(), 300);
    advice.scene = fmt::format(
        "# {0}, as 'uwvdb info' proposes to show it. File names are relative to this scene:\n"
        "#   uwvdb info '{0}' --scene > scene.yaml\n"
        "#   uwvdb render scene.yaml{1}\n",
        name, is_sequence ? " --frames FIRST-LAST" : "");
    advice.scene += proposal_yaml(advice.view.proposal) + advice.volumes;
}

VdbAdvice advise(const VdbInspection& inspection, const FrameSurvey& frames,
                 const std::filesystem::path& file) {
    VdbAdvice advice;
    choose_grids(inspection, advice);
    say_what_is_wrong(inspection, advice);
    if (advice.map.empty()) return advice;
    say_placement(inspection, advice);
    Bounds others;
    for (const SampledFrame& frame : frames.sampled)
        others.extend(held_by(frame.inspection, advice));
    advice.bounds = held_by(inspection, advice);
    advice.bounds.extend(others);
    say_units(inspection, advice);
    say_motion(inspection, advice);
    choose_concentrations(inspection, others, advice);
    write_block(inspection, file, advice);
    write_scene(file, !frames.sampled.empty(), advice);
    return advice;
}

void say_range(const FrameSurvey& frames, VdbAdvice& advice) {
    const std::vector<double> largest = largest_values(frames);
    if (largest.size() < 2) return;
    const auto [least, most] = std::ranges::minmax_element(largest);
    const auto frame_of = [&](const auto& it) {
        return frames.sampled[static_cast<std::size_t>(it - largest.begin())].frame;
    };
    advice.lines.push_back(
        fmt::format("Over the sequence ({} frames sampled) the largest value lies between {:.4g} "
                    "(frame {}) and {:.4g} (frame {}); concentrations, bounds and camera suit all "
                    "of them.",
                    largest.size(), *least, frame_of(least), *most, frame_of(most)));
    constexpr double k_flicker = 2;
    for (std::size_t n = 1; n < largest.size(); ++n) {
        const double ratio = largest[n] / largest[n - 1];
        if (ratio < k_flicker && ratio > 1 / k_flicker) continue;
        advice.lines.push_back(fmt::format(
            "Its range changes by a factor of {:.2g} from frame {} to frame {}: if that is no "
            "eruption, the frames were normalised one by one and the plume will flicker; export "
            "them with one range.",
            ratio, frames.sampled[n - 1].frame, frames.sampled[n].frame));
    }
}

}  // namespace

VdbAdvice advise_on_vdb(const VdbInspection& inspection, const std::filesystem::path& file) {
    return advise(inspection, {}, file);
}

VdbAdvice advise_on_sequence(const FrameSurvey& frames, const std::filesystem::path& pattern) {
    const auto fullest = std::ranges::max_element(
        frames.sampled, {}, [](const SampledFrame& f) { return content_of(f.inspection); });
    VdbAdvice advice = advise(fullest->inspection, frames, pattern);
    say_range(frames, advice);
    return advice;
}

}  // namespace uw
