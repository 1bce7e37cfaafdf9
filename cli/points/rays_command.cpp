#include "cli/points/rays_command.h"

#include <fmt/format.h>

#include <array>
#include <atomic>
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

void run_rays(const PointsArguments& a) {
    const ThreadLimit limit(a.threads);
    const ResolvedScene scene = observed_scene(a);
    const Camera camera = camera_of_truth(scene.desc());
    const std::array<std::vector<std::string_view>, 2> names{{{"pixel_x", "pixel_y"}, {"x", "y"}}};
    const CoordinateTable pixels = read_coordinates(a.table, names);
    std::atomic<std::size_t> outside = 0, without_ray = 0;
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
    print_message(fmt::format("{} pixels: {} outside the image, {} without a ray into the water\n",
                              pixels.row_count(), outside.load(), without_ray.load()));
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
