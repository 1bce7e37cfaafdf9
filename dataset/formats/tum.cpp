#include <fmt/format.h>

#include <string>

#include "dataset/formats/formats.h"
#include "dataset/formats/poses.h"

namespace uw {

namespace {

constexpr double k_tum_depth_scale = 5000;  // per metre, the benchmark's

/// "tum/", or "tum/left/" in a rig: the benchmark's sequences have one camera.
std::string tum_folder(const DatasetDefinition& definition, const View& view) {
    const std::string& camera = definition.cameras[view.camera];
    return definition.folder(view.draw) + "tum/" + (camera.empty() ? "" : camera + "/");
}

std::string tum_stamp(double time) {
    return fmt::format("{:.6f}", time);
}

void write_tum_images(const ViewImages& images, SetFiles& files) {
    const std::string folder = tum_folder(images.definition, images.view);
    const std::string file = tum_stamp(images.time) + ".png";
    write_image(images, files, "image.tum", folder + "rgb/" + file);
    write_depth(images, files, "depth.tum", folder + "depth/" + file, k_tum_depth_scale);
}

void write_tum_tables(const CompleteSequence& sequence, SetFiles& files) {
    const DatasetDefinition& definition = sequence.definition;
    for (std::size_t camera = 0; camera < definition.cameras.size(); ++camera) {
        std::string rgb = "# color images\n# timestamp filename\n";
        std::string depth = "# depth maps\n# timestamp filename\n";
        std::string truth = "# ground truth trajectory\n# timestamp tx ty tz qx qy qz qw\n";
        std::string associations;
        for (std::size_t frame = 0; frame < definition.frames.size(); ++frame) {
            const ViewRecord& record = sequence.at(frame, camera);
            const std::string time = tum_stamp(record.time);
            rgb += fmt::format("{0} rgb/{0}.png\n", time);
            depth += fmt::format("{0} depth/{0}.png\n", time);
            associations += fmt::format("{0} rgb/{0}.png {0} depth/{0}.png\n", time);
            const auto [p, q] = camera_pose(record.camera);
            truth +=
                fmt::format("{} {} {} {} {} {} {} {}\n", time, p.x, p.y, p.z, q.x, q.y, q.z, q.w);
        }
        const std::string folder = tum_folder(definition, {sequence.draw, 0, camera});
        files.add_bytes("tum", folder + "rgb.txt", rgb);
        files.add_bytes("tum", folder + "depth.txt", depth);
        files.add_bytes("tum", folder + "groundtruth.txt", truth);
        files.add_bytes("tum", folder + "associations.txt", associations);
    }
}

}  // namespace

DatasetFormat tum_format() {
    return {.name = "tum",
            .summary = "tum/: RGB-D sequence of the TUM benchmark, depth at 5000 per metre",
            .card =
                "`tum/`: as the TUM RGB-D benchmark has it, a folder per camera of a rig: `rgb/` "
                "and `depth/` named by time in seconds, depth as PNG of 16 bits at 5000 per metre "
                "(0: none), `rgb.txt`, `depth.txt`, `associations.txt`, and `groundtruth.txt` "
                "with the camera's pose in the world (x right, y down, z forward).",
            .layers = "depth",
            .write_view = write_tum_images,
            .complete = write_tum_tables};
}

}  // namespace uw
