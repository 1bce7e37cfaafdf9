#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "camera/camera.h"
#include "camera/colmap_calibration.h"
#include "core/base/error.h"
#include "core/base/output_files.h"
#include "dataset/formats.h"
#include "dataset/surface_points.h"

namespace uw {

namespace {

/// The data of a point once all views exist.
struct Track {
    std::array<int, 3> rgb{};  // from the first image that shows it
    double error = 0;          // sum of the distances between its images and the stock model's [px]
    struct Place {
        std::uint32_t image, observation;
    };
    std::vector<Place> places;

    // COLMAP has no points that only one image shows.
    bool is_kept() const { return places.size() > 1; }
};

bool has_ports(const CompleteSequence& sequence) {
    return std::ranges::any_of(
        sequence.records, [](const ViewRecord& record) { return record.camera.port.has_value(); });
}

std::string cameras_text(const CompleteSequence& sequence, bool with_port) {
    const std::size_t count = sequence.definition.cameras.size();
    std::string text =
        "# Camera list with one line of data per camera:\n"
        "#   CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]";
    text += with_port ? " [REFRAC_MODEL, REFRAC_PARAMS[]]\n" : "\n";
    text += fmt::format("# Number of cameras: {}\n", count);
    if (!with_port && has_ports(sequence))
        text += fmt::format(
            "# These models know no port: they are those of the cameras {}. The points of\n"
            "# images.txt are seen through the port; ../refractive/cameras.txt describes it.\n",
            sequence.definition.pinhole_fit ? "fitted to the rays in water" : "in air");
    for (std::size_t camera = 0; camera < count; ++camera)
        text += colmap_camera_line(
            camera + 1, with_port ? sequence.at(0, camera).camera : sequence.portless(camera),
            true);
    return text;
}

std::filesystem::path observation_file(const ViewRecord& record, const SetFiles& files) {
    return files.folder() / record.file("observations")->path;
}

std::vector<Track> tracks_of(const CompleteSequence& sequence, const std::vector<Landmark>& points,
                             const SetFiles& files) {
    std::vector<Track> tracks(points.size());
    for (std::size_t i = 0; i < sequence.records.size(); ++i) {
        const ViewRecord& record = sequence.records[i];
        CameraDesc stock = sequence.portless(record.view.camera);
        stock.world_from_camera = record.camera.world_from_camera;
        const Camera camera(stock);
        const std::vector<Observation> seen = read_observations(observation_file(record, files));
        for (std::size_t k = 0; k < seen.size(); ++k) {
            if (seen[k].point >= points.size())
                throw InputError(fmt::format("{}: names a point that does not exist",
                                             observation_file(record, files).string()));
            Track& track = tracks[seen[k].point];
            if (track.places.empty()) track.rgb = seen[k].rgb;
            const auto pixel = camera.project(points[seen[k].point].position);
            if (pixel) track.error += std::hypot(pixel->x - seen[k].x, pixel->y - seen[k].y);
            track.places.push_back(
                {static_cast<std::uint32_t>(i + 1), static_cast<std::uint32_t>(k)});
        }
    }
    return tracks;
}

/// One image is read at a time: the observations of thousands would fill the memory.
void write_colmap_images(const CompleteSequence& sequence, const std::vector<Track>& tracks,
                         const SetFiles& files, const std::filesystem::path& file) {
    std::size_t observed = 0;
    for (const Track& track : tracks) observed += track.is_kept() ? track.places.size() : 0;
    OutputFile out(file);
    out.write(
        fmt::format("# Image list with two lines of data per image:\n"
                    "#   IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, CAMERA_ID, NAME\n"
                    "#   POINTS2D[] as (X, Y, POINT3D_ID)\n"
                    "# Number of images: {}, mean observations per image: {}\n",
                    sequence.records.size(),
                    static_cast<double>(observed) / static_cast<double>(sequence.records.size())));
    for (std::size_t i = 0; i < sequence.records.size(); ++i) {
        const ViewRecord& record = sequence.records[i];
        const auto [position, world_from_camera] = camera_pose(record.camera);
        const Rotation q = world_from_camera.inverse();
        const Vector3 t = -(q.matrix() * from_origin(position));
        std::string text =
            fmt::format("{} {} {} {} {} {} {} {} {} {}\n", i + 1, q.w, q.x, q.y, q.z, t.x, t.y, t.z,
                        record.view.camera + 1, within(sequence, "images/", *record.file("image")));
        const char* separator = "";
        for (const Observation& o : read_observations(observation_file(record, files))) {
            text += fmt::format("{}{} {} {}", separator, o.x, o.y,
                                tracks[o.point].is_kept() ? std::to_string(o.point + 1) : "-1");
            separator = " ";
        }
        out.write(text + "\n");
    }
    out.commit();
}

void write_colmap_points(const std::vector<Landmark>& points, const std::vector<Track>& tracks,
                         const std::filesystem::path& file) {
    std::size_t count = 0, observed = 0;
    for (const Track& track : tracks)
        if (track.is_kept()) {
            ++count;
            observed += track.places.size();
        }
    OutputFile out(file);
    out.write(fmt::format(
        "# 3D point list with one line of data per point:\n"
        "#   POINT3D_ID, X, Y, Z, R, G, B, ERROR, TRACK[] as (IMAGE_ID, POINT2D_IDX)\n"
        "# Number of points: {}, mean track length: {}\n",
        count, count > 0 ? static_cast<double>(observed) / static_cast<double>(count) : 0));
    for (std::size_t i = 0; i < tracks.size(); ++i) {
        const Track& track = tracks[i];
        if (!track.is_kept()) continue;
        const Point3& p = points[i].position;
        std::string text = fmt::format("{} {} {} {} {} {} {} {:.6g}", i + 1, p.x, p.y, p.z,
                                       track.rgb[0], track.rgb[1], track.rgb[2],
                                       track.error / static_cast<double>(track.places.size()));
        for (const Track::Place& place : track.places)
            text += fmt::format(" {} {}", place.image, place.observation);
        out.write(text + "\n");
    }
    out.commit();
}

/// A PLY of the points and their colours. Readers take coordinates of single precision.
std::string point_cloud_text(const std::vector<Landmark>& points,
                             const std::vector<Track>& tracks) {
    std::string vertices;
    for (std::size_t i = 0; i < tracks.size(); ++i) {
        if (!tracks[i].is_kept()) continue;
        const Point3& p = points[i].position;
        vertices += fmt::format("{} {} {} {}\n", static_cast<float>(p.x), static_cast<float>(p.y),
                                static_cast<float>(p.z), fmt::join(tracks[i].rgb, " "));
    }
    return fmt::format(
               "ply\nformat ascii 1.0\nelement vertex {}\n"
               "property float x\nproperty float y\nproperty float z\n"
               "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n",
               std::ranges::count_if(tracks, &Track::is_kept)) +
           vertices;
}

void write_model(const CompleteSequence& sequence, SetFiles& files) {
    const std::vector<Landmark> points =
        read_points(files.folder() / points_file(sequence.definition, sequence.draw));
    const std::vector<Track> tracks = tracks_of(sequence, points, files);
    const std::string folder = sequence.folder + "sparse/0/";
    files.add_bytes("colmap", folder + "cameras.txt", cameras_text(sequence, false));
    files.add("colmap", folder + "images.txt", [&](const std::filesystem::path& file) {
        write_colmap_images(sequence, tracks, files, file);
    });
    files.add("colmap", folder + "points3D.txt", [&](const std::filesystem::path& file) {
        write_colmap_points(points, tracks, file);
    });
    if (sequence.definition.has_format("nerfstudio"))
        files.add_bytes("nerfstudio", sequence.folder + k_point_cloud_file,
                        point_cloud_text(points, tracks));
    if (has_ports(sequence))
        files.add_bytes("colmap", sequence.folder + "sparse/refractive/cameras.txt",
                        cameras_text(sequence, true));
}

void check_one_pose(const DatasetDefinition&, const SceneDesc& scene) {
    if (scene.camera.line_time > 0)
        throw UsageError(
            "--format colmap: its images have one pose each, but every row of a rolling shutter "
            "has its own; leave the format out, or give --set camera.line_time=0");
}

}  // namespace

DatasetFormat colmap_format() {
    return {.name = "colmap",
            .summary = "sparse/0: COLMAP's text model, points of surfaces; brings png along",
            .card =
                "`sparse/0/`: COLMAP's `cameras.txt`, `images.txt` and `points3D.txt`, beside "
                "`images/`: camera from world, x right, y down, z forward, the first pixel's "
                "centre at (0.5, 0.5). Points are exact points of surfaces that do not move, "
                "observed where the camera sees them, to 1e-6 px, in every image in which "
                "nothing hides them. Behind a port the stock models cannot express what the "
                "camera sees: `cameras.txt` is the camera in air, or fitted (above), "
                "observations are those through the port, the column ERROR says by how much they "
                "differ, and `sparse/refractive/cameras.txt` describes the port in the words of "
                "COLMAP's refractive fork. Poses are the true camera's.",
            .needs_points = true,
            .needs_images = true,
            .ports = DatasetFormat::Ports::fitted,
            .check = check_one_pose,
            .write_view =
                [](const ViewImages& images, SetFiles& files) {
                    files.add_bytes("observations",
                                    images.definition.file(images.view, "views", ".points.csv"),
                                    observations_csv(observations(images)));
                },
            .complete = write_model};
}

}  // namespace uw
