#include "cli/info/vdb_advice.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include "core/base/error.h"
#include "core/base/input_files.h"
#include "core/base/parallel.h"
#include "core/base/text.h"
#include "core/light/medium.h"
#include "core/scene/render_desc.h"
#include "core/scene/yaml_document.h"
#include "media/volumes/fluid_domain.h"
#include "media/volumes/grid_field.h"
#include "media/volumes/load_volumes.h"
#include "media/volumes/vdb_header.h"
#include "media/water/water_model.h"

namespace uw {

namespace {

/// Adds a line to the advice.
template <class... Values>
void say(VdbAdvice& advice, fmt::format_string<Values...> format, Values&&... values) {
    advice.lines.push_back(fmt::format(format, std::forward<Values>(values)...));
}

bool contains_any(const std::string& text, std::initializer_list<const char*> parts) {
    return std::ranges::any_of(
        parts, [&](const char* part) { return text.find(part) != std::string::npos; });
}

/// The names that liquid solvers give to the distances to their surface.
bool is_name_of_distances(const std::string& name) {
    const std::string text = lower_case(name);
    return text.starts_with("phi") || contains_any(text, {"surface", "levelset", "level_set"});
}

/// Distances to a surface, in grids whose class does not say so.
bool is_level_set_in_disguise(const GridInspection& grid) {
    return grid.values && grid.summary.grid_class != "fog volume" && grid.values->negative > 0 &&
           (grid.values->background_value > 0 || is_name_of_distances(grid.summary.base_name));
}

/// Its grids that contain the surface or the particles of a simulated liquid.
std::vector<std::string> grids_of_liquid(const VdbInspection& inspection) {
    std::vector<std::string> names;
    for (const GridInspection& grid : inspection.grids) {
        const std::string& type = grid.summary.value_type;
        const std::string name = lower_case(grid.summary.base_name);
        const bool is_surface =
            (grid.summary.grid_class == "level set" || is_level_set_in_disguise(grid)) &&
            (is_name_of_distances(name) || contains_any(name, {"liquid", "fluid", "flip"}));
        const bool are_particles = type.starts_with("ptdataidx") || type.starts_with("ptidx");
        if (is_surface || are_particles) names.push_back(grid.summary.name);
    }
    return names;
}

/// A name as YAML reads it, also within brackets.
std::string quoted_name(const std::string& text) {
    const bool plain = !text.empty() && std::ranges::all_of(text, [](unsigned char c) {
        return std::isalnum(c) != 0 || c == '_';
    }) && std::isalpha(static_cast<unsigned char>(text[0])) != 0;
    if (plain && lower_case(text) != "null" && lower_case(text) != "true" &&
        lower_case(text) != "false")
        return text;
    return in_yaml_quotes(text);
}

std::string list(const std::vector<std::string>& names) {
    return fmt::format("'{}'", fmt::join(names, "', '"));
}

/// Whether its values can be concentrations, whatever its name.
bool can_be_mapped(const GridInspection& grid) {
    return grid.unusable.empty() && grid.unread.empty() && grid.values && grid.values->max > 0 &&
           !is_level_set_in_disguise(grid);
}

/// Whether it is a level set whose interior can become fog. The surface of a liquid cannot: its
/// interior is water.
bool is_fillable(const GridInspection& grid) {
    const std::string name = lower_case(grid.summary.base_name);
    const bool is_liquid =
        name.starts_with("phi") || contains_any(name, {"liquid", "fluid", "flip"});
    const bool is_one = grid.summary.grid_class == "level set" || is_level_set_in_disguise(grid);
    return is_one && !is_liquid && unusable_because(grid.summary, LevelSets::fog).empty() &&
           grid.unread.empty() && grid.values && grid.values->negative > 0 &&
           grid.values->background_value > 0 && std::isfinite(grid.values->background_value);
}

/// The likeliest concentration of those that can be mapped, or without one a level set that can be
/// filled; nullptr if there is none.
const GridInspection* likeliest_grid(const VdbInspection& inspection) {
    int best = 0;
    const GridInspection* chosen = nullptr;
    for (const GridInspection& grid : inspection.grids) {
        if (!can_be_mapped(grid)) continue;
        const int likelihood = concentration_likelihood(grid.summary.base_name);
        if (likelihood <= best) continue;
        best = likelihood;
        chosen = &grid;
    }
    if (chosen != nullptr) return chosen;
    const auto level_set = std::ranges::find_if(inspection.grids, is_fillable);
    return level_set == inspection.grids.end() ? nullptr : &*level_set;
}

/// Decides `advice.map`, and sets `advice.bounds` to the bounds of these grids.
void say_what_to_map(const VdbInspection& inspection, VdbAdvice& advice) {
    const GridInspection* const chosen = likeliest_grid(inspection);
    if (chosen == nullptr) {
        const std::vector<std::string> liquid = grids_of_liquid(inspection);
        advice.lines.push_back(
            liquid.empty()
                ? "Nothing to map: no grid of this file is a concentration."
                : fmt::format(
                      "Nothing to map: this looks like a liquid simulation, whose surface or "
                      "particles are in {}. A surface is geometry: export it as a mesh (.glb, .obj "
                      "or .ply) and name that under geometry; for dye, sediment or bubbles in the "
                      "liquid export a fog volume.",
                      list(liquid)));
        return;
    }
    if (is_fillable(*chosen)) {
        advice.map = {chosen->summary.name};
        advice.level_sets = LevelSets::fog;
        advice.bounds = chosen->world_bounds;
        say(advice,
            "Map {} as fog: it is a level set (distances to a surface), and level_set: fog fills "
            "its inside with the value 1, which fades towards the surface within its narrow band. "
            "If it is the surface of a solid, export that as a mesh (.glb, .obj or .ply) and name "
            "it under geometry.",
            list(advice.map));
        return;
    }
    for (const GridInspection& grid : inspection.grids)
        if (grid.summary.base_name == chosen->summary.base_name && can_be_mapped(grid)) {
            advice.map.push_back(grid.summary.name);
            advice.bounds.extend(grid.world_bounds);
        }
    const int best = concentration_likelihood(chosen->summary.base_name);
    const char* const why = best == 4   ? "the name says density"
                            : best == 3 ? "by its name a concentration"
                            : best == 2 ? "the only likely one; its name says nothing"
                                        : "no density in this file, and this is the closest to it: "
                                          "check that it is what you mean";
    if (advice.map.size() == 1)
        say(advice, "Map {}: {}.", list(advice.map), why);
    else
        say(advice, "{} grids are called '{}': address them as {}. Map those you mean.",
            advice.map.size(), chosen->summary.base_name, list(advice.map));
}

/// Grids with valid values that are not concentrations.
void say_what_to_leave(const VdbInspection& inspection, VdbAdvice& advice) {
    std::vector<std::string> others;
    for (const GridInspection& grid : inspection.grids) {
        const bool mapped = std::ranges::count(advice.map, grid.summary.name) > 0;
        if (mapped || !can_be_mapped(grid)) continue;
        if (concentration_likelihood(grid.summary.base_name) < 2)
            others.push_back(grid.summary.name);
    }
    if (!others.empty()) say(advice, "Not a concentration by name: {}.", list(others));
}

void say_what_is_wrong(const GridInspection& grid, VdbAdvice& advice) {
    const std::string name = fmt::format("Grid '{}' ", grid.summary.name);
    const auto say = [&](const std::string& text) { advice.lines.push_back(name + text + "."); };
    if (!grid.unusable.empty()) say(grid.unusable);
    if (grid.unusable.empty() && is_level_set_in_disguise(grid))
        say("is a level set, though its class does not say so (its inside is negative, and its "
            "background above 0 or its name that of distances), not a concentration; give its "
            "volume level_set: fog, which fills its inside, or export a fog volume");
    if (grid.unusable.empty() && !grid.unread.empty()) say("cannot be read: " + grid.unread);
    if (grid.active_voxels == 0) say("is empty: it has no active voxels");
    if (!grid.values || grid.values->active == 0 || !grid.unusable.empty()) return;
    const ValueSummary& v = *grid.values;
    if (v.nan > 0)
        say(fmt::format("has {} NaN among its {}: counted as 0", v.nan,
                        counted(v.active, "value")));
    if (v.infinite > 0)
        say(fmt::format("has {}: counted as 0", counted(v.infinite, "infinite value")));
    if (v.negative > 0 && v.negative < v.finite && !is_level_set_in_disguise(grid))
        say(fmt::format("has {}: counted as 0", counted(v.negative, "negative value")));
    if (v.finite > 0 && v.max <= 0)
        say(fmt::format("has no value above 0 (from {:g} to {:g}): it would be invisible", v.min,
                        v.max));
    if (v.background_value != 0 && !is_level_set_in_disguise(grid))
        say("has a background of " + v.background + ": it counts as 0 outside the active voxels");
}

constexpr std::size_t k_max_sampled = 6;
constexpr std::size_t k_max_faults = 3;

/// Whether a grid of the file may contain a concentration, by its header.
bool may_hold_something(const VdbHeader& header) {
    return std::ranges::any_of(header.grids, [](const GridSummary& grid) {
        const bool is_level_set =
            grid.grid_class == "level set" && unusable_because(grid, LevelSets::fog).empty();
        const bool may_be_mapped =
            unusable_because(grid).empty() && concentration_likelihood(grid.base_name) > 0;
        return (is_level_set || may_be_mapped) && grid.active_voxels.value_or(1) > 0;
    });
}

// Larger than lamps can light under water; too small to be the intended size [m].
constexpr double k_too_large = 12, k_too_small = 0.05;
constexpr double k_convenient = 2;  // the size to which volumes are scaled

double longest_side(const Bounds& b) {
    return std::max({b.max.x - b.min.x, b.max.y - b.min.y, b.max.z - b.min.z});
}

// Farther from the origin than a scene is wide [m].
constexpr double k_far_off = 1000;

bool lacks(const VdbInspection& inspection, const std::string& part) {
    return std::ranges::none_of(inspection.grids, [&](const GridInspection& grid) {
        return lower_case(grid.summary.base_name).find(part) != std::string::npos;
    });
}

std::string sides_text(const Vector3& sides) {
    return fmt::format("{:.4g} x {:.4g} x {:.4g} m", sides.x, sides.y, sides.z);
}

/// The size of Blender's voxels, which its files state as cubes.
void say_domain(const VdbInspection& inspection, VdbAdvice& advice) {
    const auto domain = find_fluid_domain(inspection.header);
    if (domain && domain->is_adaptive) {
        advice.lines.push_back("The voxel size is wrong: " + domain->description() + ".");
        if (domain->voxel) return;
        const double step = std::pow(10, std::floor(std::log10(domain->max_voxel())) - 3);
        advice.voxel_size = std::floor(domain->max_voxel() / step + 1e-6) * step;
        return;
    }
    const auto mapped = std::ranges::find_if(inspection.grids, [&](const GridInspection& grid) {
        return grid.summary.name == advice.map.front();
    });
    if (!mapped->summary.base_resolution || !mapped->summary.voxel_edge) return;
    const std::array<std::int32_t, 3>& count = *mapped->summary.base_resolution;
    const double edge = *mapped->summary.voxel_edge;
    if (domain && domain->voxel) {
        constexpr double k_rounding = 1e-5;
        const Vector3& h = *domain->voxel;
        if (glm::length(h - edge) > k_rounding * edge)
            say(advice,
                "The file states voxels of {:.4g} m, which Blender stretches to fill the domain's "
                "box: {} is taken from the cache's folder config.",
                edge, sides_text(h));
        return;
    }
    say(advice,
        "Blender stretches voxels to fill the domain, which the file does not hold: unless its "
        "Dimensions are {} (Blender's x, y, z), keep the cache's folder config beside data, or "
        "give transform.scale: [X/{:.6g}, Z/{:.6g}, Y/{:.6g}] of Dimensions X, Y and Z.",
        sides_text(edge * Vector3(count[0], count[1], count[2])), edge * count[0], edge * count[2],
        edge * count[1]);
}

/// The position of the domain in Blender, in the scene's axes; empty if it is not known.
std::optional<Affine> place_in_blender(const VdbInspection& inspection) {
    if (inspection.placement.up != UpAxis::z) return std::nullopt;
    const auto domain = find_fluid_domain(inspection.header);
    if (!domain || !domain->blender_from_domain) return std::nullopt;
    const Affine upright = upright_from_file(UpAxis::z);
    return upright * *domain->blender_from_domain * upright.inverse();
}

/// The up axis and the centering of values, by the program that wrote the file.
void say_axes(const VdbInspection& inspection, VdbAdvice& advice) {
    const VdbHeader& header = inspection.header;
    const std::string up =
        inspection.placement.automatic_up
            ? ""
            : fmt::format(" But --up says that it is {}.", name_of_up(inspection.placement.up));
    if (header.from_blender_fluid()) {
        say(advice,
            "Up is z, values sit in the middle of cells: a cache of Blender's fluid solver, "
            "recognised by its grids. Index (0, 0, 0) is the domain's corner{}.{}",
            place_in_blender(inspection)
                ? ""
                : "; the file does not record where that is: translate it there, (x, y, z) in "
                  "Blender is [x, z, -y] here",
            up);
        say_domain(inspection, advice);
        return;
    }
    if (header.from_embergen()) {
        say(advice,
            "Up is z, values sit at nodes (index i at i times the voxel): written by EmberGen, "
            "recognised by its metadata or its grid 'flames'.{}{}",
            lacks(inspection, "density")
                ? " It has no density: tick that channel in the export node, if the smoke is meant."
                : "",
            up);
        return;
    }
    const bool houdini = header.from_houdini();
    const char* const hint =
        houdini      ? ""
        : up.empty() ? " If it lies on its side, ask again with --up z, or write up: z; if half a "
                       "voxel off, centering: cell."
                     : " If half a voxel off, write centering: cell.";
    say(advice, "Up is y, values sit at nodes (index i at i times the voxel): {}.{}{}",
        houdini ? fmt::format("written by Houdini, as its creator '{}' says", header.creator)
                : "nothing in the file says otherwise",
        up, hint);
}

/// The placement of a volume by the file's transform and the advice.
Affine placing(const VdbAdvice& advice) {
    return Affine::translation(advice.translate) * Affine::rotation_xyz_degrees(advice.rotate) *
           Affine::scale(advice.scale * advice.mirror);
}

double rounded(double value, double step) {
    return std::round(value / step) * step;
}

/// The angles of Affine::rotation_xyz_degrees that make this rotation.
Vector3 angles_of(const Matrix3& rotation) {
    const auto at = [&](int row, int column) { return rotation[column][row]; };
    const double y = std::asin(std::clamp(-at(2, 0), -1.0, 1.0));
    constexpr double k_upright = 1e-6;  // x and z turn about the same axis
    if (std::cos(y) < k_upright) return Vector3(std::atan2(-at(1, 2), at(1, 1)), y, 0) / k_degree;
    return Vector3(std::atan2(at(2, 1), at(2, 2)), y, std::atan2(at(1, 0), at(0, 0))) / k_degree;
}

/// A domain's axes as a rotation of a box that may be mirrored. Axes that are sheared have the
/// nearest rotation, in the sum of squares.
struct Turn {
    Matrix3 rotation;
    Vector3 mirror{1};
    bool is_sheared = false;
};

Turn turn_of(const Matrix3& axes) {
    // Newton's iteration for the orthogonal factor of the polar decomposition.
    Turn turn{axes};
    constexpr int k_steps = 60;
    for (int step = 0; step < k_steps; ++step)
        turn.rotation = 0.5 * (turn.rotation + glm::transpose(glm::inverse(turn.rotation)));
    constexpr double k_rounding = 1e-4;  // of the file's floats
    for (int axis = 0; axis < 3; ++axis)
        turn.is_sheared |= glm::length(turn.rotation[axis] - axes[axis]) > k_rounding;
    if (glm::determinant(turn.rotation) > 0) return turn;
    // Any axis would do; this one leaves the smallest rotation, whose trace is the largest.
    int mirrored = 0;
    for (int axis = 1; axis < 3; ++axis)
        if (turn.rotation[axis][axis] < turn.rotation[mirrored][mirrored]) mirrored = axis;
    turn.mirror[mirrored] = -1;
    turn.rotation[mirrored] *= -1;
    return turn;
}

/// Decides `mirror`, `rotate` and `translate`. `has_size`: the file's transform is meaningful.
void say_place(const VdbInspection& inspection, bool has_size, VdbAdvice& advice) {
    const double side = advice.scale * longest_side(advice.bounds);
    if (const auto place = place_in_blender(inspection)) {
        constexpr double k_metres = 1e-6, k_degrees = 1e-4;  // of the file's floats
        const Turn turn = turn_of(place->linear());
        const Vector3 angles = angles_of(turn.rotation);
        advice.mirror = turn.mirror;
        for (int axis = 0; axis < 3; ++axis) {
            advice.rotate[axis] = rounded(angles[axis], k_degrees) + 0.0;
            advice.translate[axis] = rounded(advice.scale * place->offset()[axis], k_metres) + 0.0;
        }
        const Vector3& t = place->offset();
        say(advice,
            "Its domain had its corner at ({:.4g}, {:.4g}, {:.4g}) in Blender{}{}, as the cache's "
            "folder config says: the block puts it there, beside what the same scene exports as "
            ".glb.",
            t.x, -t.z, t.y, advice.rotate == Vector3(0) ? "" : " and was turned",
            turn.mirror == Vector3(1) ? "" : " and mirrored");
        if (turn.is_sheared)
            say(advice,
                "A parent that is scaled shears it in Blender, which no transform here does: the "
                "block has the nearest rotation. Apply the parent's scale, and bake again.");
    } else if (!has_size && advice.bounds.min.y < 0) {
        const double step = std::pow(10, std::floor(std::log10(side)) - 3);
        advice.translate.y = std::ceil(-advice.scale * advice.bounds.min.y / step) * step;
        say(advice,
            "Without a size its place means nothing, either: the block puts it onto y = 0.");
    }
    const Vector3 centre = from_origin(placing(advice) * advice.bounds.center());
    if (!(glm::length(centre) > k_far_off) || !std::isfinite(glm::length(centre))) return;
    advice.translate -= glm::round(centre);
    say(advice,
        "It lies {:.3g} m from the origin, as if in the coordinates of a map: the block brings it "
        "to the origin; give cameras, lamps and surfaces the same translation.",
        glm::length(centre));
}

std::string size_of(const VdbAdvice& advice) {
    return fmt::format("{:.3g} m", longest_side(advice.bounds));
}

/// Decides `scale`; whether the file has a size at all.
bool say_size(const VdbInspection& inspection, VdbAdvice& advice) {
    const double side = longest_side(advice.bounds);
    if (!(side > 0) || !std::isfinite(side)) return true;
    bool unit_voxels = false;
    for (const GridInspection& grid : inspection.grids)
        if (grid.summary.name == advice.map.front())
            unit_voxels = grid.voxel_size == Vector3(1.0, 1.0, 1.0);
    const double power = std::pow(10, std::floor(std::log10(k_convenient / side)));
    const double fitting = power * std::floor(k_convenient / side / power);
    const auto plausible = [&](double scale) {
        return side * scale >= 0.2 && side * scale <= 0.5 * k_too_large;
    };
    if (unit_voxels) {
        advice.scale = fitting;
        say(advice,
            "Units look wrong: a voxel is exactly 1 m, as if no size was set, and the whole {}. "
            "Give its true size with transform.scale; {:g} makes it {:.3g} m.",
            size_of(advice), fitting, fitting * side);
    } else if (side > k_too_large) {
        advice.scale = plausible(0.01) ? 0.01 : fitting;
        say(advice,
            "Units look wrong: {} is more than lamps can light under water; {}"
            "transform.scale: {:g} makes it {:.3g} m.",
            size_of(advice), plausible(0.01) ? "if these are centimetres, " : "", advice.scale,
            advice.scale * side);
    } else if (side < k_too_small) {
        advice.scale = plausible(100) ? 100 : fitting;
        say(advice,
            "Units look wrong: {} is very small; {}transform.scale: {:g} makes it {:.3g} m.",
            size_of(advice), plausible(100) ? "if it was scaled by 1/100 on export, " : "",
            advice.scale, advice.scale * side);
    } else {
        say(advice, "Units are plausible: {} along its longest side.", size_of(advice));
    }
    return !unit_voxels;
}

/// How to blur it by its motion, if the file has velocities.
void say_motion(const VdbInspection& inspection, VdbAdvice& advice) {
    const auto has = [&](const std::string& name) {
        return std::ranges::any_of(inspection.grids, [&](const GridInspection& grid) {
            return grid.summary.name == name && grid.unread.empty() && grid.active_voxels != 0;
        });
    };
    // velocity_previous, vel_before and the like are those of another moment.
    std::string grid;
    for (const GridInspection& candidate : inspection.grids)
        if (candidate.summary.value_type == "vec3s" && has(candidate.summary.name) &&
            lower_case(candidate.summary.base_name).starts_with("vel") &&
            (grid.empty() || candidate.summary.name.size() < grid.size()))
            grid = candidate.summary.name;
    if (!grid.empty()) grid = quoted_name(grid);
    if (grid.empty() && has("vel.x") && has("vel.y") && has("vel.z"))
        grid = "[vel.x, vel.y, vel.z]";
    if (grid.empty()) return;
    say(advice,
        "It moves: for motion blur add velocity: {{grid: {}}} to the volume, and the "
        "exposure time in "
        "seconds as render: {{shutter: 0.02}}.{}",
        grid,
        inspection.header.from_blender_fluid()
            ? " Its unit is 2.5 voxels a second, as in Blender's solver."
            : " Its unit is taken to be m/s.");
}

/// Decides `fps`.
void say_frame_rate(const VdbInspection& inspection, VdbAdvice& advice) {
    const std::optional<double> rate = fluid_frame_rate(inspection.header.file);
    if (!rate || *rate == RenderDesc().fps) return;
    advice.fps = rate;
    say(advice,
        "It was baked at {:.4g} frames a second (with Time Scale 1), as the cache's "
        "folder config says, and scenes without render.fps have {:g}: the scene that "
        "--scene prints has that key.",
        *rate, RenderDesc().fps);
}

}  // namespace

int concentration_likelihood(const std::string& name) {
    const std::string text = lower_case(name);
    if (contains_any(text, {"shadow", "vel", "phi_", "pressure", "divergence", "curl", "color",
                            "flags", "sdf", "surface", "distance", "normal", "particle_id",
                            "gradient", "collision", "mask"}) ||
        text == "cd" || text == "v" || text == "id" || text == "rest")
        return 0;
    if (contains_any(text, {"temp", "heat", "flame", "fire", "fuel", "react", "burn", "emission"}))
        return 1;
    if (text.find("density") != std::string::npos) return 4;
    if (contains_any(text, {"smoke", "fog", "cloud", "dust", "plume", "concentration", "sediment",
                            "soot", "dye", "tracer", "ppm", "silt"}))
        return 3;
    return 2;
}

FrameSurvey survey_frames(const std::filesystem::path& pattern, const std::vector<int>& frames,
                          UpAxis up) {
    FrameSurvey survey;
    const auto guarded = [&](int frame, const auto& look) {
        const std::filesystem::path file = file_of_frame(pattern, frame);
        try {
            look(file, printable(file.filename().string(), 300));
        } catch (const std::runtime_error& error) {
            if (survey.faults.size() < k_max_faults) survey.faults.emplace_back(error.what());
        }
    };
    std::vector<int> candidates;
    for (const int frame : frames)
        guarded(frame, [&](const std::filesystem::path& file, const std::string& name) {
            const bool holds = may_hold_something(read_vdb_header(file, name));
            (holds ? candidates : survey.empty).push_back(frame);
        });
    const std::size_t count = std::min(candidates.size(), k_max_sampled);
    for (std::size_t n = 0; n < count; ++n) {
        const int frame = candidates[count == 1 ? 0 : n * (candidates.size() - 1) / (count - 1)];
        guarded(frame, [&](const std::filesystem::path& file, const std::string& name) {
            SampledFrame sampled{frame, inspect_vdb(file, name, up)};
            if (likeliest_grid(sampled.inspection) != nullptr)
                survey.sampled.push_back(std::move(sampled));
            else
                survey.empty.push_back(frame);
        });
    }
    std::ranges::sort(survey.empty);
    return survey;
}

std::vector<double> max_values(const FrameSurvey& survey) {
    std::vector<double> values;
    for (const SampledFrame& frame : survey.sampled) {
        const GridInspection& grid = *likeliest_grid(frame.inspection);
        values.push_back(is_fillable(grid) ? 1 : grid.values->max);
    }
    return values;
}

namespace {

constexpr double k_wanted_depth = 1.5;
constexpr double k_large_per_small = 5;
constexpr double k_max_small = 1e12 / k_large_per_small;  // the limit of scenes on both [ppm]
/// Values beyond these are not ppm, whatever the plume.
constexpr double k_min_usual = 1e-6, k_max_usual = 1e6;
constexpr std::size_t k_wanted_band = 1;         // of the default bands: 540 nm
constexpr int k_lines = 24, k_fewest_lines = 4;  // across each side
constexpr double k_max_regions = 2e6;            // blocks and tiles that all of them meet

double round_to_two_digits(double value) {
    const double power = std::pow(10, std::floor(std::log10(value)) - 1);
    return std::round(value / power) * power;
}

/// The largest value of the grids to map; 1, that of the fog, for a level set.
double max_value(const VdbInspection& inspection, const VdbAdvice& advice) {
    double largest = 0;
    for (const GridInspection& grid : inspection.grids)
        if (std::ranges::count(advice.map, grid.summary.name) > 0 && grid.values)
            largest = std::max(largest, grid.values->max);
    return advice.level_sets == LevelSets::fog || !(largest > 0) ? 1 : largest;
}

/// The concentration with which drafts begin [ppm per unit]: 1, or for values too large or too
/// small for that, the one that makes the largest of them 1 ppm.
double first_small_ppm(const VdbInspection& inspection, const VdbAdvice& advice) {
    const double largest = max_value(inspection, advice);
    return largest < k_min_usual || largest > k_max_usual ? 1 / largest : 1;
}

VolumeDesc describe(const VdbInspection& inspection, const VdbAdvice& advice) {
    VolumeDesc desc;
    desc.file = inspection.header.file;
    desc.where = desc.file.filename().string();
    desc.up = inspection.placement.up;
    desc.level_sets = advice.level_sets;
    desc.world_from_upright = placing(advice);
    desc.voxel_size = advice.voxel_size;
    for (const std::string& name : advice.map) {
        GridMappingDesc mapping;
        mapping.grid = name;
        mapping.where = desc.where;
        mapping.small_ppm = first_small_ppm(inspection, advice);
        mapping.large_ppm = k_large_per_small * mapping.small_ppm;
        desc.grids.push_back(mapping);
    }
    return desc;
}

/// The optical depth per band across the densest voxel, which lines may miss in a sparse grid.
std::vector<double> across_voxel(const LoadedVolume& volume, const Medium& medium) {
    const AttenuationTable attenuation(medium);
    std::vector<double> depth(static_cast<std::size_t>(medium.band_count()));
    for (const VolumeReport& report : volume.reports) {
        const Vector3& h = report.metres_per_voxel;
        std::vector<double> columns(static_cast<std::size_t>(medium.constituent_count()));
        for (const ConstituentReport& part : report.constituents)
            columns[static_cast<std::size_t>(part.constituent)] +=
                part.max * std::min({h.x, h.y, h.z});
        for (int band = 0; band < medium.band_count(); ++band) {
            double& most = depth[static_cast<std::size_t>(band)];
            most = std::max(most, attenuation.optical_depth(band, 0, columns));
        }
    }
    return depth;
}

/// The bounds of all voxels that are not 0.
Bounds bounds_of(const LoadedVolume& volume) {
    Bounds bounds;
    for (const GridVolume& grid : volume.grids) bounds.extend(grid.voxel_bounds());
    return bounds;
}

/// Lines along `axis`, `across` by `across` of them, spaced evenly over the bounds.
std::vector<std::pair<Point3, Point3>> lines_along(const Bounds& bounds, int axis, int across) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    std::vector<std::pair<Point3, Point3>> lines;
    for (int i = 0; i < across; ++i)
        for (int j = 0; j < across; ++j) {
            Point3 a = bounds.min, b = bounds.max;
            a[u] = b[u] = std::lerp(bounds.min[u], bounds.max[u], (i + 0.5) / across);
            a[v] = b[v] = std::lerp(bounds.min[v], bounds.max[v], (j + 0.5) / across);
            lines.emplace_back(a, b);
        }
    return lines;
}

/// How many lines along a side of the bounds are affordable, whatever the grids contain, estimated
/// by the regions that a few of them meet.
int affordable_lines(const GridField& field, const Bounds& bounds, int axis) {
    double regions = 0;
    for (const auto& [a, b] : lines_along(bounds, axis, k_fewest_lines))
        for (const GridVolume& volume : field.volumes())
            regions += static_cast<double>(volume.regions_along(a, b));
    const double each = std::max(1.0, regions / (k_fewest_lines * k_fewest_lines));
    return std::clamp(static_cast<int>(std::sqrt(k_max_regions / each)), k_fewest_lines, k_lines);
}

/// The largest optical depth per band of `depth` and of the lines along `axis`.
std::vector<double> deepest(const GridField& field, const Medium& medium, const Bounds& bounds,
                            int axis, std::vector<double> depth) {
    AttenuationTable attenuation(medium);
    attenuation.uniform = {};
    const auto lines = lines_along(bounds, axis, affordable_lines(field, bounds, axis));
    std::vector<std::vector<double>> columns(lines.size());
    parallel_for(lines.size(), [&](std::size_t n) {
        columns[n].resize(static_cast<std::size_t>(medium.constituent_count()));
        field.column(lines[n].first, lines[n].second, columns[n]);
    });
    for (const std::vector<double>& column : columns)
        for (std::size_t band = 0; band < depth.size(); ++band)
            depth[band] = std::max(depth[band], attenuation.optical_depth(band, 0, column));
    return depth;
}

}  // namespace

void start_concentrations(const VdbInspection& inspection, VdbAdvice& advice) {
    const VolumeDesc desc = describe(inspection, advice);
    const WaterDesc water;
    const WaterModel model = build_water_model(water, {desc});
    LoadedVolume volume = load_volume(desc, model.loads[0]);
    const std::vector<double> least = across_voxel(volume, model.medium);
    advice.bounds = bounds_of(volume);
    const GridField field(std::move(volume.grids), model.medium.constituent_count());
    std::array<std::vector<double>, 3> depths;
    for (int axis = 0; axis < 3; ++axis)
        depths[static_cast<std::size_t>(axis)] =
            deepest(field, model.medium, advice.bounds, axis, least);
    std::ranges::sort(depths, {}, [](const std::vector<double>& d) { return d[k_wanted_band]; });

    const double first = desc.grids.front().small_ppm;
    const double wanted = first * k_wanted_depth / depths[1][k_wanted_band];
    advice.small_ppm = std::min(round_to_two_digits(wanted), k_max_small);
    advice.large_ppm = k_large_per_small * advice.small_ppm;
    advice.bands_nm = water.bands_nm;
    advice.optical_depth.clear();
    for (const double depth : depths[1])
        advice.optical_depth.push_back(depth * advice.small_ppm / first);
}

void choose_concentrations(const VdbInspection& inspection, const Bounds& others, VdbAdvice& advice,
                           const InfoProgress& progress) {
    start_concentrations(inspection, advice);
    const Affine world_from_upright = placing(advice);
    if (!others.empty())
        for (const Point3& corner : {others.min, others.max})
            advice.bounds.extend(world_from_upright * corner);
    VolumeDesc desc = describe(inspection, advice);
    for (GridMappingDesc& mapping : desc.grids) {
        mapping.small_ppm = advice.small_ppm;
        mapping.large_ppm = advice.large_ppm;
    }
    advice.view = view_plume(desc, advice.bounds, progress);
    const double small_ppm =
        std::min(round_to_two_digits(advice.view.factor * advice.small_ppm), k_max_small);
    for (double& depth : advice.optical_depth) depth *= small_ppm / advice.small_ppm;
    advice.small_ppm = small_ppm;
    advice.large_ppm = k_large_per_small * small_ppm;
    const double contrast = advice.view.draft.contrast;
    say(advice,
        "small: {:g} and large: {:g} ppm per unit give an optical depth of about {:.2g} at {:g} nm "
        "through the densest part, and a contrast of {:.0f} % where it is clearest (median over "
        "its pixels {:.2g} %) in a picture of the scene that --scene prints (in {}{}): {}. Your "
        "own "
        "plume's concentration may differ.",
        advice.small_ppm, advice.large_ppm, advice.optical_depth[k_wanted_band],
        advice.bands_nm[k_wanted_band], 100 * contrast, 100 * advice.view.draft.median_contrast,
        advice.view.proposal.water, advice.view.needs_all_light() ? ", in all light" : "",
        contrast >= k_plain_to_see ? "neither invisible nor black"
                                   : "it will hardly be seen; a smaller transform.scale brings "
                                     "camera and lamps nearer");
    if (advice.view.needs_all_light())
        say(advice,
            "Single scattering leaves out about {:.0f} % of that scene's light: it asks for all of "
            "it, with render.scattering: multiple.",
            100 * advice.view.left_out->fraction);
}

namespace {

/// Whether some of the active voxels of the mapped grids are empty, as in dense grids.
bool has_empty_voxels(const VdbInspection& inspection, const VdbAdvice& advice) {
    return std::ranges::any_of(inspection.grids, [&](const GridInspection& grid) {
        return std::ranges::count(advice.map, grid.summary.name) > 0 && grid.values &&
               grid.values->zero + grid.values->negative + grid.values->nan > 0;
    });
}

/// The contents of the mapped grids, with the file's size and placement unless these are known to
/// be wrong.
Bounds held_by(const VdbInspection& inspection, const VdbAdvice& advice) {
    if (has_empty_voxels(inspection, advice)) {
        try {
            const VolumeDesc desc = describe(inspection, advice);
            const Bounds bounds =
                bounds_of(load_volume(desc, build_water_model(WaterDesc(), {desc}).loads[0]));
            if (!bounds.empty()) return bounds;
        } catch (const InputError&) {
            // A frame that lacks one of the grids: its active voxels will do.
        }
    }
    const auto domain = find_fluid_domain(inspection.header);
    const VolumeDesc desc = describe(inspection, advice);
    const Affine upright = upright_from_file(inspection.placement.up);
    Bounds bounds;
    for (const GridInspection& grid : inspection.grids) {
        if (std::ranges::count(advice.map, grid.summary.name) == 0) continue;
        if (grid.world_bounds.empty()) continue;
        Affine corrected;
        if (desc.voxel_size || domain) {
            const Affine stated = Affine::scale(grid.voxel_size);
            corrected =
                upright * with_voxel_size(stated, desc, domain) * (upright * stated).inverse();
        }
        for (const Point3& corner : {grid.world_bounds.min, grid.world_bounds.max})
            bounds.extend(corrected * corner);
    }
    return bounds;
}

/// The contents of the likeliest grid: the sum of its values.
double content_of(const VdbInspection& inspection) {
    const GridInspection* const grid = likeliest_grid(inspection);
    if (is_fillable(*grid)) return static_cast<double>(grid->values->negative);
    return grid->values->mean * static_cast<double>(grid->values->finite);
}

void write_block(const VdbInspection& inspection, const std::filesystem::path& file,
                 VdbAdvice& advice) {
    std::string& yaml = advice.volumes;
    yaml = "volumes:\n";
    yaml += fmt::format("  - file: {}\n    grids:\n", quoted_name(file.string()));
    for (const std::string& name : advice.map)
        yaml += fmt::format("      {}: {{small: {:g}, large: {:g}}}    # ppm per unit\n",
                            quoted_name(name), advice.small_ppm, advice.large_ppm);
    const Placement& p = inspection.placement;
    if (advice.level_sets == LevelSets::fog) yaml += "    level_set: fog\n";
    yaml += fmt::format("    centering: {}\n    up: {}\n",
                        p.centering == Centering::cell ? "cell" : "node", name_of_up(p.up));
    if (advice.voxel_size)
        yaml +=
            fmt::format("    voxel_size: {:g}    # at most: see the advice\n", *advice.voxel_size);
    const Vector3& t = advice.translate;
    const Vector3& r = advice.rotate;
    const std::string rotate =
        r == Vector3(0) ? "" : fmt::format("rotate: [{:.8g}, {:.8g}, {:.8g}], ", r.x, r.y, r.z);
    const Vector3 factors = advice.scale * advice.mirror;
    const std::string scale =
        advice.mirror == Vector3(1)
            ? fmt::format("{:g}", advice.scale)
            : fmt::format("[{:g}, {:g}, {:g}]", factors.x, factors.y, factors.z);
    yaml += fmt::format("    transform: {{scale: {}, {}translate: [{:.12g}, {:.12g}, {:.12g}]}}\n",
                        scale, rotate, t.x, t.y, t.z);
}

void write_scene(const std::filesystem::path& file, bool is_sequence, VdbAdvice& advice) {
    const std::string name = printable(file.string(), 300);
    advice.scene = fmt::format(
        "# {0}, as 'uwvdb info' proposes to show it. File names are relative to this scene:\n"
        "#   uwvdb info '{0}' --scene > scene.yaml\n"
        "#   uwvdb render scene.yaml{1}\n",
        name, is_sequence ? " --frames FIRST-LAST" : "");
    advice.scene += proposal_yaml(advice.view.proposal) + advice.volumes;
    std::string scattering = "single";
    if (advice.view.needs_all_light())
        scattering = fmt::format("multiple    # single leaves out about {:.0f} % of the light",
                                 100 * advice.view.left_out->fraction);
    else if (advice.view.left_out)
        scattering += "      # which leaves out hardly any light here";
    advice.scene += fmt::format("render:\n  scattering: {}\n", scattering);
    if (advice.fps) advice.scene += fmt::format("  fps: {:.6g}\n", *advice.fps);
}

/// The possible meaning of values that are far from any concentration in ppm.
void say_unit(const VdbInspection& inspection, VdbAdvice& advice) {
    const double largest = max_value(inspection, advice);
    const std::string& name = advice.map.front();
    if (largest > k_max_usual)
        say(advice,
            "Its values reach {:.3g}, more than a million ppm: they may be numbers of particles, "
            "whose volume depends on their size. For a grid of particles per m3 write, in place of "
            "small and large, {}: {{silt: 1 /m3}} (per ml or cm3 1e6 /m3), with water: {{species: "
            "{{silt: {{library: silt}}}}}} or another species; a particle of diameter d has pi/6 "
            "d^3, at 10 um 5.2e-10 ppm per particle and m3.",
            largest, quoted_name(name));
    else if (largest < k_min_usual)
        say(advice,
            "Its values reach {:.3g} only: they may be fractions by volume, of which 1 is 1e6 ppm "
            "(write {}: {{small: 1e6, large: 0}}), or masses in kg/m3, with a species {{silt: 1000 "
            "g/m3}}. What the block below gives is as much as makes it plain to see.",
            largest, quoted_name(name));
}

/// A scene's sea floor is often at y = 0, and hides what is below.
void say_what_is_below(VdbAdvice& advice) {
    const double lowest = advice.bounds.min.y, side = longest_side(advice.bounds);
    constexpr double k_rounding = 1e-3;  // of its size
    if (!(lowest < -k_rounding * side)) return;
    const Vector3& t = advice.translate;
    say(advice,
        "Its lowest point lies at y = {} m, below y = 0: the floor of the scene that --scene "
        "prints "
        "is lower still, but one at y = 0 would hide it; transform.translate: [{:.15g}, {}, "
        "{:.15g}] puts it onto that.",
        length_text(lowest, side), t.x, length_text(t.y - lowest, side), t.z);
}

VdbAdvice advise(const VdbInspection& inspection, const FrameSurvey& frames,
                 const std::filesystem::path& file, const InfoProgress& progress) {
    VdbAdvice advice;
    say_what_to_map(inspection, advice);
    say_what_to_leave(inspection, advice);
    for (const GridInspection& grid : inspection.grids)
        if (advice.level_sets == LevelSets::refused || grid.summary.name != advice.map.front())
            say_what_is_wrong(grid, advice);
    if (advice.map.empty()) return advice;
    say_axes(inspection, advice);
    Bounds others;
    for (const SampledFrame& frame : frames.sampled)
        others.extend(held_by(frame.inspection, advice));
    advice.bounds = held_by(inspection, advice);
    advice.bounds.extend(others);
    const bool has_size = say_size(inspection, advice);
    say_place(inspection, has_size, advice);
    say_motion(inspection, advice);
    if (!frames.sampled.empty()) say_frame_rate(inspection, advice);
    say_unit(inspection, advice);
    choose_concentrations(inspection, others, advice, progress);
    say_what_is_below(advice);
    write_block(inspection, file, advice);
    write_scene(file, !frames.sampled.empty(), advice);
    return advice;
}

void say_range(const FrameSurvey& frames, VdbAdvice& advice) {
    const std::vector<double> largest = max_values(frames);
    if (largest.size() < 2) return;
    const auto [least, most] = std::ranges::minmax_element(largest);
    const auto frame_of = [&](const auto& it) {
        return frames.sampled[static_cast<std::size_t>(it - largest.begin())].frame;
    };
    say(advice,
        "Over the sequence ({} frames sampled) the largest value lies between {:.4g} "
        "(frame {}) and {:.4g} (frame {}); concentrations, bounds and camera suit all "
        "of them.",
        largest.size(), *least, frame_of(least), *most, frame_of(most));
    constexpr double k_flicker = 2;
    for (std::size_t n = 1; n < largest.size(); ++n) {
        const double ratio = largest[n] / largest[n - 1];
        if (ratio < k_flicker && ratio > 1 / k_flicker) continue;
        say(advice,
            "Its range changes by a factor of {:.2g} from frame {} to frame {}: if that is no "
            "eruption, the frames were normalised one by one and the plume will flicker; export "
            "them with one range.",
            ratio, frames.sampled[n - 1].frame, frames.sampled[n].frame);
    }
}

}  // namespace

VdbAdvice advise_on_vdb(const VdbInspection& inspection, const std::filesystem::path& file,
                        const InfoProgress& progress) {
    return advise(inspection, {}, file, progress);
}

VdbAdvice advise_on_sequence(const FrameSurvey& frames, const std::filesystem::path& pattern,
                             const InfoProgress& progress) {
    const auto fullest = std::ranges::max_element(
        frames.sampled, {}, [](const SampledFrame& f) { return content_of(f.inspection); });
    VdbAdvice advice = advise(fullest->inspection, frames, pattern, progress);
    say_range(frames, advice);
    return advice;
}

}  // namespace uw
