#include "cli/points/points_options.h"

#include <utility>

namespace uw {

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
They are nan outside the image and where no ray enters the water.
Exit codes: 0 done, 1 internal fault, 2 wrong usage, 3 bad input, 4 cannot read or write,
130 interrupted.)";

Options points_options(PointsArguments& a, std::string table_name, std::string table_help) {
    Options options;
    options.path("SCENE", "", a.scene, "scene file (docs/scene-file.md)").required = true;
    options.path(std::move(table_name), "", a.table, std::move(table_help)).required = true;
    options.path("-o,--output", "OUT.csv", a.output,
                 "the table to write; default: standard output");
    options.text("--camera", "NAME", a.camera, "which camera of a rig");
    options.set(a.overrides);
    options.size(a.size, "as if rendered at this size, the intrinsics scaled with it");
    options.integer("--frame", "N", a.frame, 0, 999'999'999,
                    "which frame of meshes that are a sequence");
    options.threads(a.threads);
    options.flag("--quiet", a.quiet, "print nothing but warnings and errors");
    return options;
}

}  // namespace uw
