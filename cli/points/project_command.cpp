#include "cli/points/project_command.h"

#include <fmt/format.h>

#include <array>
#include <atomic>
#include <cmath>
#include <iterator>
#include <memory>

#include "cli/console.h"
#include "cli/points/coordinate_table.h"
#include "cli/points/observed_scene.h"
#include "cli/stop_signal.h"
#include "cli/text_files.h"
#include "core/base/parallel.h"
#include "render/exposure.h"
#include "render/seen_point.h"

namespace uw {

void run_project(const PointsArguments& a) {
    const ThreadLimit limit(a.threads);
    const ResolvedScene observed = observed_scene(a);
    const Camera camera = camera_of_truth(observed.desc());
    const AssembledScene scene = with_surfaces(observed);
    const std::array<std::vector<std::string_view>, 1> names{{{"x", "y", "z"}}};
    const CoordinateTable points = read_coordinates(a.table, names);
    std::atomic<std::size_t> visible = 0, occluded = 0, outside = 0;
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
    print_message(fmt::format(
        "{} points: {} visible, {} behind surfaces, {} outside the image, {} without a ray\n",
        points.row_count(), visible.load(), occluded.load(), outside.load(),
        points.row_count() - visible - occluded - outside));
}

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

}  // namespace uw
