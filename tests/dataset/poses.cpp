// ctest labels: unit analytic
// The poses of a moving camera in every format that has them, against each other and the scene.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <sstream>

#include "camera/calibration.h"
#include "camera/camera.h"
#include "core/image/image_file.h"
#include "core/scene/pose_file.h"
#include "tests/support/dataset/dataset_scenes.h"

namespace uw {
namespace {

constexpr const char* k_pose_formats = "depth,colmap,nerfstudio,tum,euroc,calibration";

struct ColmapImage {
    int id = 0, camera = 0;
    Rotation camera_from_world;
    Vector3 translation{0.0};
    std::string name;
    struct Point {
        double x, y;
        long id;
    };
    std::vector<Point> points;
};

struct ColmapPoint {
    Point3 position;
    double error = 0;
    std::vector<std::pair<int, int>> track;  // image, index of its point
};

class DatasetPoses : public test::DatasetTest {
  protected:
    /// Where the scene says that the camera is: on a straight line, its axis turning.
    static Vector3 position(int frame) { return Vector3(0.5, 0.1, 0.2) * (frame / 6.0); }

    void expect_poses(const std::vector<TimedPose>& poses, bool counts_frames) const {
        ASSERT_EQ(poses.size(), 7U);
        for (int frame = 0; frame < 7; ++frame) {
            const TimedPose& timed = poses[static_cast<std::size_t>(frame)];
            // TUM's times have six decimals.
            EXPECT_NEAR(timed.time, counts_frames ? frame : frame / 6.0, 1e-6);
            const Vector3 off = from_origin(timed.pose.position) - position(frame);
            EXPECT_LT(glm::length(off), 1e-12);
        }
        const auto axis = [&](std::size_t i) {
            return poses[i].pose.rotation.matrix() * Vector3(0, 0, 1);
        };
        EXPECT_LT(glm::length(axis(0) - Vector3(0, 0, 1)), 1e-9);
        EXPECT_LT(glm::length(axis(6) - glm::normalize(Vector3(-0.4, -0.1, 3.8))), 1e-9);
    }

    std::vector<ColmapImage> colmap_images() const {
        std::istringstream lines(read("set/sparse/0/images.txt"));
        std::vector<ColmapImage> images;
        for (std::string line; std::getline(lines, line);) {
            if (line.starts_with("#")) continue;
            ColmapImage image;
            std::istringstream cells(line);
            Rotation& q = image.camera_from_world;
            Vector3& t = image.translation;
            cells >> image.id >> q.w >> q.x >> q.y >> q.z >> t.x >> t.y >> t.z >> image.camera >>
                image.name;
            std::getline(lines, line);
            std::istringstream points(line);
            ColmapImage::Point p{};
            while (points >> p.x >> p.y >> p.id) image.points.push_back(p);
            images.push_back(std::move(image));
        }
        return images;
    }
    std::map<long, ColmapPoint> colmap_points() const {
        std::istringstream lines(read("set/sparse/0/points3D.txt"));
        std::map<long, ColmapPoint> points;
        for (std::string line; std::getline(lines, line);) {
            if (line.starts_with("#")) continue;
            std::istringstream cells(line);
            long id = 0;
            int r = 0, g = 0, b = 0;
            ColmapPoint point;
            Point3& p = point.position;
            cells >> id >> p.x >> p.y >> p.z >> r >> g >> b >> point.error;
            EXPECT_TRUE(r >= 0 && r <= 255 && g >= 0 && g <= 255 && b >= 0 && b <= 255);
            for (int image = 0, index = 0; cells >> image >> index;)
                point.track.emplace_back(image, index);
            points[id] = point;
        }
        return points;
    }
    /// That images and points name each other, and each point often enough.
    void expect_consistent(const std::vector<ColmapImage>& images,
                           const std::map<long, ColmapPoint>& points) const {
        std::size_t in_images = 0, in_tracks = 0;
        for (const ColmapImage& image : images)
            for (const ColmapImage::Point& point : image.points) in_images += point.id >= 0 ? 1 : 0;
        for (const auto& [id, point] : points) {
            EXPECT_GE(point.track.size(), 2U);
            in_tracks += point.track.size();
            for (const auto& [image, index] : point.track) {
                const ColmapImage& seen = images.at(static_cast<std::size_t>(image - 1));
                EXPECT_EQ(seen.id, image);
                EXPECT_EQ(seen.points.at(static_cast<std::size_t>(index)).id, id);
            }
        }
        EXPECT_EQ(in_images, in_tracks);
        EXPECT_GT(points.size(), 1000U);
    }
};

TEST_F(DatasetPoses, AreTheScenesInEveryFormat) {
    make("moving.yaml", k_pose_formats);
    const auto poses = [&](const char* file, PoseFormat format) {
        return read_pose_file(folder_ / "set" / file, format, "test").poses;
    };
    expect_poses(poses("tum/groundtruth.txt", PoseFormat::tum), false);
    expect_poses(poses("mav0/state_groundtruth_estimate0/data.csv", PoseFormat::euroc), false);
    expect_poses(poses("sparse/0/images.txt", PoseFormat::colmap), true);
    expect_poses(poses("transforms.json", PoseFormat::nerfstudio), true);
}

// The written scene moves as the files say if they are its trajectory.
TEST_F(DatasetPoses, RenderTheSameImagesWhenReadAgain) {
    make("moving.yaml", "png,tum", {"--frames", "0-3"});
    const auto result = run(
        {"dataset", "moving.yaml", "-o", "again", "--format", "png", "--frames", "0-3", "--set",
         "camera.trajectory={file: set/tum/groundtruth.txt, format: tum, interpolation: linear}",
         "--set", "render.times=trajectory", "--quiet"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    for (int frame = 0; frame < 4; ++frame) {
        const auto pixels = [&](const char* set) {
            return read_image(folder_ / fmt::format("{}/images/{:06}.png", set, frame)).pixels;
        };
        const std::vector<float> first = pixels("set"), again = pixels("again");
        ASSERT_EQ(first.size(), again.size());
        // Poses are the same to rounding, so that a value may be rounded the other way.
        for (std::size_t i = 0; i < first.size(); ++i) EXPECT_NEAR(first[i], again[i], 1.001 / 255);
    }
}

TEST_F(DatasetPoses, ColmapsModelReprojectsExactly) {
    make("moving.yaml", "colmap");
    EXPECT_FALSE(exists("set/sparse/refractive"));
    EXPECT_NE(read("set/sparse/0/cameras.txt").find("\n1 PINHOLE 40 30 36 35 19 15.5\n"),
              std::string::npos);
    const std::vector<ColmapImage> images = colmap_images();
    const std::map<long, ColmapPoint> points = colmap_points();
    ASSERT_EQ(images.size(), 7U);
    expect_consistent(images, points);
    double worst = 0;
    for (const ColmapImage& image : images) {
        EXPECT_TRUE(exists("set/images/" + image.name));
        for (const auto& [x, y, id] : image.points) {
            if (id < 0) continue;
            const Vector3 p =
                image.camera_from_world.matrix() * from_origin(points.at(id).position) +
                image.translation;
            worst = std::max(worst, std::hypot(36 * p.x / p.z + 19 - x, 35 * p.y / p.z + 15.5 - y));
        }
    }
    EXPECT_LT(worst, 1e-5);  // points are exact, projections to 1e-6 px
    for (const auto& [id, point] : points) {
        EXPECT_LT(point.error, 1e-5);
        const Point3& p = point.position;
        const bool is_on_wall = std::abs(p.z - 4) < 1e-5;
        const bool is_on_box = p.x > 0.2 - 1e-5 && p.x < 0.6 + 1e-5 && p.y > -0.3 - 1e-5 &&
                               p.y < 0.2 + 1e-5 && p.z > 1.5 - 1e-5 && p.z < 1.9 + 1e-5;
        EXPECT_TRUE(is_on_wall || is_on_box) << p.x << " " << p.y << " " << p.z;
    }
    // Behind the box nothing of the wall is seen, in whichever frame: a shadow of 0.4 m at 1.5 m.
    const ColmapImage& first = images.front();
    for (const auto& [x, y, id] : first.points) {
        if (id < 0) continue;
        const Point3& p = points.at(id).position;
        const double at_box_x = p.x * 1.5 / p.z, at_box_y = p.y * 1.5 / p.z;
        const bool is_behind =
            p.z > 3.9 && at_box_x > 0.21 && at_box_x < 0.59 && at_box_y > -0.29 && at_box_y < 0.19;
        EXPECT_FALSE(is_behind);
    }
}

TEST_F(DatasetPoses, APortIsInTheObservationsAndDescribed) {
    const test::ProgramResult made =
        run({"dataset", "moving.yaml", "-o", "set", "--format", "colmap,calibration", "--quiet",
             "--set", "camera.port={type: flat, distance: 0.02, thickness: 0.03}"});
    ASSERT_EQ(made.exit_code, 0) << made.err;
    const std::vector<ColmapImage> images = colmap_images();
    const std::map<long, ColmapPoint> points = colmap_points();
    expect_consistent(images, points);
    CameraDesc desc = read_calibration(folder_ / "set/sparse/refractive/cameras.txt").desc;
    ASSERT_TRUE(desc.port);
    double worst = 0, stock = 0;
    for (const ColmapImage& image : images) {
        const Rotation world_from_camera = image.camera_from_world.inverse();
        desc.world_from_camera = {world_from_camera.matrix(),
                                  -(world_from_camera.matrix() * image.translation)};
        const Camera camera(desc);
        for (const auto& [x, y, id] : image.points) {
            if (id < 0) continue;
            const auto pixel = camera.project(points.at(id).position);
            ASSERT_TRUE(pixel);
            worst = std::max(worst, std::hypot(pixel->x - x, pixel->y - y));
        }
    }
    for (const auto& [id, point] : points) stock = std::max(stock, point.error);
    EXPECT_LT(worst, 1e-5);
    EXPECT_GT(stock, 3);  // a third of some 15 px from the axis
    EXPECT_NE(read("set/sparse/0/cameras.txt").find("know no port"), std::string::npos);
    EXPECT_TRUE(exists("set/calibration/calibmar.yaml"));
    EXPECT_FALSE(exists("set/calibration/opencv.yaml"));  // it has no ports
}

TEST_F(DatasetPoses, TumsTablesNameItsFiles) {
    make("moving.yaml", "png,tum", {"--frames", "0-2"});
    std::istringstream lines(read("set/tum/associations.txt"));
    std::string rgb_time, rgb, depth_time, depth;
    int frames = 0;
    while (lines >> rgb_time >> rgb >> depth_time >> depth) {
        EXPECT_EQ(rgb_time, depth_time);
        EXPECT_TRUE(read("set/tum/" + rgb) == read(fmt::format("set/images/{:06}.png", frames++)));
        EXPECT_TRUE(exists("set/tum/" + depth));
        EXPECT_NE(read("set/tum/rgb.txt").find(rgb_time + " " + rgb + "\n"), std::string::npos);
        EXPECT_NE(read("set/tum/depth.txt").find(rgb_time + " " + depth + "\n"), std::string::npos);
    }
    EXPECT_EQ(frames, 3);
}

TEST_F(DatasetPoses, EurocOfARig) {
    make("pair.yaml", "euroc,nerfstudio");
    for (const char* camera : {"cam0", "cam1"}) {
        EXPECT_EQ(read(fmt::format("set/mav0/{}/data.csv", camera)),
                  "#timestamp [ns],filename\n1400000000000000000,1400000000000000000.png\n");
        EXPECT_TRUE(exists(fmt::format("set/mav0/{}/data/1400000000000000000.png", camera)));
    }
    const std::string right = read("set/mav0/cam1/sensor.yaml");
    EXPECT_NE(right.find("data: [1, 0, 0, 0.1,"), std::string::npos) << right;
    // The first pixel's centre is (0, 0) there.
    EXPECT_NE(right.find("intrinsics: [36, 35, 17.5, 15] #fu, fv, cu, cv\n"), std::string::npos);
    const std::string transforms = read("set/transforms.json");
    EXPECT_NE(transforms.find("\"file_path\": \"images/right/000000.png\""), std::string::npos);
}

TEST_F(DatasetPoses, EurocsVelocityIsThatOfTheMotion) {
    make("moving.yaml", "euroc");
    std::istringstream lines(read("set/mav0/state_groundtruth_estimate0/data.csv"));
    std::string line;
    std::getline(lines, line);
    int rows = 0;
    for (; std::getline(lines, line); ++rows) {
        std::vector<double> cells;
        std::istringstream stream(line);
        for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(std::stod(cell));
        ASSERT_EQ(cells.size(), 17U);
        EXPECT_NEAR(cells[8], 0.5, 1e-9);
        EXPECT_NEAR(cells[9], 0.1, 1e-9);
        EXPECT_NEAR(cells[10], 0.2, 1e-9);
    }
    EXPECT_EQ(rows, 7);
}

}  // namespace
}  // namespace uw
