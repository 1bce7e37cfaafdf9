#include "cli/tools/points_commands.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "camera/camera.h"
#include "cli/console.h"
#include "cli/image_choice.h"
#include "cli/process.h"
#include "core/base/csv_table.h"
#include "core/base/error.h"
#include "core/base/input_files.h"
#include "core/base/parallel.h"
#include "core/base/text.h"
#include "render/exposure.h"
#include "render/image_scene.h"
#include "render/scene_assembly.h"
#include "render/scene_cache.h"
#include "render/scene_loading.h"
#include "render/view_matcher.h"

namespace uw {

namespace {

constexpr std::size_t k_rows_per_part = 4096;

/// NaN for `nan`; none for what is no number.
std::optional<double> coordinate_in(std::string_view cell) {
    if (same_ignoring_case(cell, "nan")) return std::numeric_limits<double>::quiet_NaN();
    double value = 0;
    if (parse_number(cell, value) != NumberText::number) return std::nullopt;
    return value;
}

bool contains_numbers(const std::vector<std::string_view>& cells) {
    return std::ranges::all_of(
        cells, [](std::string_view cell) { return coordinate_in(cell).has_value(); });
}

std::optional<std::size_t> column_called(std::string_view name,
                                         const std::vector<std::string>& columns) {
    const auto found = std::ranges::find_if(
        columns, [&](const std::string& column) { return same_ignoring_case(column, name); });
    if (found == columns.end()) return std::nullopt;
    return static_cast<std::size_t>(found - columns.begin());
}

}  // namespace

CoordinateTable::CoordinateTable(std::string text, std::string name, NameSets names)
    : text_(std::move(text)), name_(std::move(name)), width_(names.front().size()) {
    std::string_view rest = text_;
    skip_byte_order_mark(rest);
    for (int line_number = 1; !rest.empty(); ++line_number) {
        const std::string_view line = trimmed(take_line(rest));
        if (line.empty() || line.front() == '#') continue;
        if (!columns_.empty()) {
            read_row(line, line_number);
            continue;
        }
        read_header(line, line_number, names);
        if (contains_numbers(csv_cells(line))) read_row(line, line_number);
    }
    if (lines_.empty())
        throw InputError(
            fmt::format("{}: no rows; give a line that names the columns {}, and a "
                        "line for each point",
                        name_, fmt::join(names.front(), ", ")));
}

void CoordinateTable::read_header(std::string_view line, int line_number, NameSets names) {
    const std::vector<std::string_view> cells = csv_cells(line);
    if (contains_numbers(cells)) {
        if (cells.size() != width_)
            throw InputError(fmt::format(
                "{}:{}: {} without a header; name the columns in a first line, such as "
                "{}, or leave those alone",
                name_, line_number,
                cells.size() == 1 ? "1 number" : fmt::format("{} numbers", cells.size()),
                fmt::join(names.front(), ",")));
        columns_.assign(names.front().begin(), names.front().end());
        header_ = fmt::format("{}", fmt::join(columns_, ","));
        for (std::size_t i = 0; i < width_; ++i) chosen_.push_back(i);
        return;
    }
    columns_.assign(cells.begin(), cells.end());
    header_ = line;
    for (const std::vector<std::string_view>& set : names) {
        chosen_.clear();
        for (const std::string_view column : set)
            if (const auto index = column_called(column, columns_)) chosen_.push_back(*index);
        if (chosen_.size() == width_) return;
    }
    std::string wanted, present;
    for (const std::vector<std::string_view>& set : names)
        wanted += fmt::format("{}{}", wanted.empty() ? "" : ", or ", fmt::join(set, ", "));
    for (const std::string& column : columns_)
        if (present.size() < 200) present += (present.empty() ? "" : ", ") + quoted_cell(column);
    throw InputError(
        fmt::format("{}:{}: the columns {} are needed, separated by commas; the first line names "
                    "{}",
                    name_, line_number, wanted, present));
}

void CoordinateTable::read_row(std::string_view line, int line_number) {
    const std::vector<std::string_view> cells = csv_cells(line);
    if (cells.size() != columns_.size())
        throw InputError(fmt::format(
            "{}:{}: {} where there are {} columns; give one cell per column", name_, line_number,
            cells.size() == 1 ? "1 cell" : fmt::format("{} cells", cells.size()), columns_.size()));
    for (const std::size_t column : chosen_) {
        const std::optional<double> value = coordinate_in(cells[column]);
        if (!value)
            throw InputError(fmt::format(
                "{}:{}: {} in column {} is not a finite number; write it like 0.25 or 1.5e-3, or "
                "nan where there is none",
                name_, line_number, quoted_cell(cells[column]), quoted_cell(columns_[column])));
        coordinates_.push_back(*value);
    }
    lines_.push_back(line);
}

std::string CoordinateTable::with_columns(
    const std::vector<std::string_view>& names,
    const std::function<void(std::size_t row, std::string& text)>& cells_of) const {
    for (const std::string_view name : names)
        if (column_called(name, columns_))
            throw InputError(
                fmt::format("{}: has a column {} already; rename it", name_, quoted_cell(name)));
    std::vector<std::string> parts((lines_.size() + k_rows_per_part - 1) / k_rows_per_part);
    parallel_for(parts.size(), [&](std::size_t part) {
        const std::size_t end = std::min(lines_.size(), (part + 1) * k_rows_per_part);
        for (std::size_t row = part * k_rows_per_part; row < end; ++row) {
            parts[part] += lines_[row];
            cells_of(row, parts[part]);
            parts[part] += '\n';
        }
    });
    std::string table = fmt::format("{},{}\n", header_, fmt::join(names, ","));
    for (const std::string& part : parts) table += part;
    return table;
}

namespace {

/// Reads a file of at most 1 GiB. Throws as CoordinateTable, and IoError.
CoordinateTable read_coordinates(const std::filesystem::path& file,
                                 CoordinateTable::NameSets names) {
    constexpr std::size_t k_max_file = std::size_t{1} << 30;
    const std::string subject = printable(file.string(), 300);
    return {read_text_file(file, subject, k_max_file, "table", Pipes::read), subject, names};
}

/// `uwvdb project` and `uwvdb rays` as typed.
struct PointsArguments {
    std::filesystem::path scene;
    std::filesystem::path table;             // the CSV that is read
    std::filesystem::path output;            // -o; empty: standard output
    std::string camera;                      // --camera: of a rig
    std::optional<int> frame;                // --frame: of meshes that are sequences
    std::optional<std::array<int, 2>> size;  // --size WxH
    std::optional<double> wavelength;        // --wavelength [nm]
    std::vector<std::string> overrides;      // --set key.path=value
    int threads = 0;                         // 0: all
    bool quiet = false;
};

const char* const k_project_examples = R"(Examples:
  uwvdb project plume.yaml points.csv                    to standard output
  uwvdb project plume.yaml points.csv -o pixels.csv
  uwvdb project stereo.yaml points.csv --camera left -o left.csv
  uwvdb project plume.yaml points.csv --size 480x270 | head

points.csv has the columns x, y, z, in metres in the world, and any others, which are carried along;
without a header it has these three alone. Each row gets these columns more:
  pixel_x, pixel_y  where the camera sees the point, through lens and port; the image's corner is
                    (0, 0), the first pixel's centre (0.5, 0.5); nan where no ray leads to it
  path              length of its ray in the water [m], from the outer glass surface
  in_image          1 within the image, else 0
  visible           1 within the image and behind no surface, else 0; how turbid the water is does
                    not matter
Where the port's indices depend on the wavelength, pixels are those of the band nearest to 550 nm,
as ground truth is, or of --wavelength.
Exit codes: 0 done, 1 internal fault, 2 wrong usage, 3 bad input, 4 cannot read or write,
130 interrupted.)";

const char* const k_rays_examples = R"(Examples:
  uwvdb rays plume.yaml pixels.csv                       to standard output
  uwvdb rays stereo.yaml pixels.csv --camera left -o rays.csv
  uwvdb project plume.yaml points.csv -o pixels.csv && uwvdb rays plume.yaml pixels.csv

pixels.csv has the columns pixel_x, pixel_y, as uwvdb project writes them, or x, y, and any others,
which are carried along; without a header it has these two alone. The image's corner is (0, 0), the
first pixel's centre (0.5, 0.5). Each row gets these columns more:
  origin_x, origin_y, origin_z           where the pixel's ray enters the water, on the outer glass
                                         surface [m, in the world]
  direction_x, direction_y, direction_z  its direction in the water, of length 1, in the world
They are nan outside the image and where no ray enters the water. Where the port's indices depend on
the wavelength, rays are those of the band nearest to 550 nm, or of --wavelength.
Exit codes: 0 done, 1 internal fault, 2 wrong usage, 3 bad input, 4 cannot read or write,
130 interrupted.)";

Options points_options(PointsArguments& a, std::string table_name, std::string table_help) {
    Options options;
    options.input("SCENE", "", a.scene, "scene file (docs/scene-file.md)").required = true;
    options.input(std::move(table_name), "", a.table, std::move(table_help)).required = true;
    options.output("-o,--output", "OUT.csv", a.output,
                   "the table to write; default: standard output");
    options.text("--camera", "NAME", a.camera, "which camera of a rig");
    options.set(a.overrides);
    options.number("--wavelength", "NM", a.wavelength, k_shortest_dispersion_nm,
                   k_longest_dispersion_nm,
                   "of light in nm, where the port's indices depend on it; default: the "
                   "band nearest to 550");
    options.size(a.size, "as if rendered at this size, the intrinsics scaled with it");
    options.integer("--frame", "N", a.frame, 0, 999'999'999,
                    "which frame of meshes that are a sequence");
    options.threads(a.threads);
    options.flag("--quiet", a.quiet, "print nothing but warnings and errors");
    return options;
}

/// The scene that the arguments name, for one camera, without volumes and lamps, which neither
/// refract nor occlude.
ImageScene observed_scene(const PointsArguments& a) {
    SceneDesc desc = load_scene(a.scene, a.overrides);
    desc.volumes.clear();
    if (a.size) resize_images(desc, (*a.size)[0], (*a.size)[1]);
    const ImageChoice choice{a.frame, chosen_camera(a.camera, desc.cameras)};
    return ImageScene(std::move(desc), choice).with([&](SceneDesc& seen) {
        seen.lamps.clear();
        if (a.wavelength) set_wavelength(seen.camera, *a.wavelength);
    });
}

AssembledScene with_surfaces(const ImageScene& scene) {
    SceneCache cache;
    AssembledScene assembled = assemble_scene(scene, cache, [](Stage /*stage*/) {});
    for (const std::string& warning : assembled.geometry_warnings)
        print_message(fmt::format("warning: {}\n", warning));
    return assembled;
}

void run_project(const PointsArguments& a) {
    const ThreadLimit limit(a.threads);
    const ImageScene observed = observed_scene(a);
    const Camera camera = camera_of_truth(observed);
    const AssembledScene scene = with_surfaces(observed);
    const std::array<std::vector<std::string_view>, 1> names{{{"x", "y", "z"}}};
    const CoordinateTable points = read_coordinates(a.table, names);
    std::atomic<std::size_t> visible = 0, occluded = 0, outside = 0;
    check_outputs({a.output});
    const std::string table = points.with_columns(
        {"pixel_x", "pixel_y", "path", "in_image", "visible"},
        [&](std::size_t row, std::string& text) {
            const std::span<const double> at = points.coordinates(row);
            const SeenPoint seen = seen_point({at[0], at[1], at[2]}, camera, *scene.surfaces);
            if (seen.visible)
                ++visible;
            else if (seen.in_image)
                ++occluded;
            else if (!std::isnan(seen.path))
                ++outside;
            fmt::format_to(std::back_inserter(text), ",{},{},{},{:d},{:d}", seen.pixel.x,
                           seen.pixel.y, seen.path, seen.in_image, seen.visible);
        });
    write_text(a.output, table, a.quiet);
    if (a.quiet) return;
    print_message(
        fmt::format("{}: {} visible, {} behind surfaces, {} outside the image, {} without a ray\n",
                    counted(points.row_count(), "point"), visible.load(), occluded.load(),
                    outside.load(), points.row_count() - visible - occluded - outside));
}

void run_rays(const PointsArguments& a) {
    const ThreadLimit limit(a.threads);
    const ImageScene scene = observed_scene(a);
    const Camera camera = camera_of_truth(scene);
    const std::array<std::vector<std::string_view>, 2> names{{{"pixel_x", "pixel_y"}, {"x", "y"}}};
    const CoordinateTable pixels = read_coordinates(a.table, names);
    std::atomic<std::size_t> outside = 0, without_ray = 0;
    check_outputs({a.output});
    const std::string table = pixels.with_columns(
        {"origin_x", "origin_y", "origin_z", "direction_x", "direction_y", "direction_z"},
        [&](std::size_t row, std::string& text) {
            const std::span<const double> at = pixels.coordinates(row);
            std::optional<Ray> ray;
            if (!is_in_image({at[0], at[1]}, camera))
                ++outside;
            else if (ray = camera.refracted_ray(at[0], at[1]); !ray)
                ++without_ray;
            constexpr double k_none = SeenPoint::k_none;
            const Ray found = ray.value_or(Ray{{k_none, k_none, k_none}, Vector3(k_none)});
            fmt::format_to(std::back_inserter(text), ",{},{},{},{},{},{}", found.origin.x,
                           found.origin.y, found.origin.z, found.direction.x, found.direction.y,
                           found.direction.z);
        });
    write_text(a.output, table, a.quiet);
    if (a.quiet) return;
    print_message(fmt::format("{}: {} outside the image, {} without a ray into the water\n",
                              counted(pixels.row_count(), "pixel"), outside.load(),
                              without_ray.load()));
}

}  // namespace

Command project_command() {
    const auto arguments = std::make_shared<PointsArguments>();
    return {"project", "where the camera sees points of the world: a table of pixels",
            k_project_examples,
            points_options(*arguments, "POINTS.csv", "a table with the columns x, y, z [m]"),
            [arguments] {
                install_stop_signal();
                run_project(*arguments);
                return k_exit_done;
            }};
}

Command rays_command() {
    const auto arguments = std::make_shared<PointsArguments>();
    return {"rays", "the rays in the water that pixels see: a table of origins and directions",
            k_rays_examples,
            points_options(*arguments, "PIXELS.csv", "a table with the columns pixel_x, pixel_y"),
            [arguments] {
                install_stop_signal();
                run_rays(*arguments);
                return k_exit_done;
            }};
}

}  // namespace uw
