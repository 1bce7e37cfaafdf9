// ctest labels: unit analytic metamorphic
#include <gtest/gtest.h>

#include <random>
#include <sstream>

#include "core/base/csv_table.h"
#include "core/base/vector_math.h"
#include "core/scene/dispersion.h"
#include "tests/support/cli_test.h"

namespace uw {
namespace {

constexpr const char* k_behind_glass = R"(
  distortion: {k: [-0.1, 0.05, 0], p: [0.001, -0.0005]}
  port: {type: flat, normal: [0.05, -0.03, 1], distance: 0.02, thickness: 0.03}
  pose: {position: [1, 2, -3], look_at: [0.5, 1.5, 2], up: [0.1, -1, 0]}
)";
constexpr const char* k_plane_in_water = R"(
water: {preset: jerlov-II}
geometry:
  - {type: sphere, center: [0.7, 1.6, 0.5], radius: 0.4}
)";

class PointsCommands : public test::CliTest {
  protected:
    std::string output_of(const std::vector<std::string>& arguments) const {
        const auto result = run(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return result.out;
    }
    // Without messages.
    CsvTable table_of(std::vector<std::string> arguments) const {
        arguments.emplace_back("--quiet");
        return {output_of(arguments), "output"};
    }
};

TEST_F(PointsCommands, ProjectsByHand) {
    // f = 16.5 / tan 30 deg; a wall at z = 4, and a box from x = 0.2 to 0.6 and z = 1.5 to 1.9.
    const double f = 16.5 / std::tan(std::acos(-1.0) / 6);
    write("points.csv",
          "name,x,y,z\n"
          "axis,0,0,2\nwall,-1,0.25,4\nbeyond the wall,0,0,5\nbehind the box,0.8,0,3\n"
          "on the box,0.3,0,1.5\nfar to the side,10,0,2\nbehind the "
          "camera,0,0,-1\nunknown,nan,0,2\n");
    const auto result = run({"project", "scene.yaml", "points.csv"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.err,
              "8 points: 3 visible, 2 behind surfaces, 1 outside the image, 2 without a ray\n");
    EXPECT_TRUE(
        result.out.starts_with("name,x,y,z,pixel_x,pixel_y,path,in_image,visible\n"
                               "axis,0,0,2,16.5,9.5,2,1,1\n"))
        << result.out;
    std::istringstream lines(result.out);
    std::string line, last;
    while (std::getline(lines, line)) last = line;
    EXPECT_EQ(last, "unknown,nan,0,2,nan,nan,nan,0,0");
    // The rows before those that have no pixel, as numbers.
    const CsvTable table(result.out.substr(0, result.out.find("behind the camera")), "output");
    const std::vector<double> x = table.numbers("pixel_x"), y = table.numbers("pixel_y");
    EXPECT_NEAR(x[1], 16.5 - f / 4, 1e-9);
    EXPECT_NEAR(y[1], 9.5 + f / 16, 1e-9);
    EXPECT_NEAR(x[5], 16.5 + 5 * f, 1e-6);
    EXPECT_NEAR(table.numbers("path")[1], std::sqrt(1 + 0.0625 + 16), 1e-12);
    EXPECT_EQ(table.numbers("in_image"), (std::vector<double>{1, 1, 1, 1, 1, 0}));
    EXPECT_EQ(table.numbers("visible"), (std::vector<double>{1, 1, 0, 0, 1, 0}));
}

TEST_F(PointsCommands, AreOfTheWavelengthAskedFor) {
    write("port.yaml", std::string(R"(uwvdb: 1
camera: {resolution: [640, 480], intrinsics: {fx: 500}, port: {n_water: seawater}}
)") + k_plane_in_water);
    write("points.csv", "x,y,z\n2,0,5\n");
    // A thin window at the camera's centre: n sin is that of the point.
    const auto expected = [](double index) {
        const double sine = index * 2 / std::sqrt(29);
        return 320 + 500 * sine / std::sqrt(1 - sine * sine);
    };
    const auto pixel = [&](std::vector<std::string> more) {
        std::vector<std::string> arguments{"project", "port.yaml", "points.csv"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return table_of(std::move(arguments)).numbers("pixel_x")[0];
    };
    EXPECT_NEAR(pixel({}), expected(water_refractive_index(540, 20, 35)), 1e-9);
    EXPECT_NEAR(pixel({"--wavelength", "450"}), expected(water_refractive_index(450, 20, 35)),
                1e-9);
    expect_failure({"project", "port.yaml", "points.csv", "--wavelength", "0.45"}, 2,
                   "--wavelength");
}

TEST_F(PointsCommands, RaysOfProjectedPointsPassThroughThem) {
    for (const std::string lens : {"resolution: [640, 480]\n  intrinsics: {fx: 420, fy: 425, cx: "
                                   "322, cy: 236}",
                                   "resolution: [640, 480]\n  intrinsics: {fov_x: 50}"}) {
        write("port.yaml", "uwvdb: 1\ncamera:\n  " + lens + k_behind_glass + k_plane_in_water);
        std::mt19937_64 random(7);
        std::uniform_real_distribution<double> across(-1.2, 1.2), along(0, 40);
        std::string points = "x,y,z\n";
        for (int i = 0; i < 3000; ++i) {
            const double far = along(random);
            points += std::to_string(1 + (1 + 0.4 * far) * across(random)) + "," +
                      std::to_string(2 + (1 + 0.4 * far) * across(random)) + "," +
                      std::to_string(-2.5 + far) + "\n";
        }
        write("points.csv", points);
        const std::string pixels = output_of({"project", "port.yaml", "points.csv"});
        write("pixels.csv", pixels);
        const std::string rays = output_of({"rays", "port.yaml", "pixels.csv"});
        // Those that are seen: the rest has no rays.
        std::string seen;
        std::istringstream lines(rays);
        for (std::string line; std::getline(lines, line);)
            if (line.find("nan") == std::string::npos) seen += line + "\n";
        const CsvTable table(seen, "rays");
        ASSERT_GT(table.row_count(), 500U);
        std::vector<std::vector<double>> v;
        for (const char* column : {"x", "y", "z", "origin_x", "origin_y", "origin_z", "direction_x",
                                   "direction_y", "direction_z", "path", "in_image"})
            v.push_back(table.numbers(column));
        std::size_t occluded = 0;
        const std::vector<double> visible = table.numbers("visible");
        for (std::size_t i = 0; i < table.row_count(); ++i) {
            const Vector3 point(v[0][i], v[1][i], v[2][i]), origin(v[3][i], v[4][i], v[5][i]),
                direction(v[6][i], v[7][i], v[8][i]);
            EXPECT_NEAR(glm::length(direction), 1, 1e-12);
            EXPECT_NEAR(v[9][i], glm::length(point - origin), 1e-12);
            EXPECT_EQ(v[10][i], 1);
            // 1e-6 of a pixel, which Camera::project promises, is 2.4e-9 of the distance.
            EXPECT_LT(glm::length(glm::cross(point - origin, direction)), 2.4e-9 * v[9][i] + 1e-12);
            // The sphere in closed form.
            const Vector3 center(0.7, 1.6, 0.5);
            const double s = glm::dot(center - origin, direction);
            const double miss = glm::length(center - origin - s * direction);
            const double entry = s - std::sqrt(std::max(0.0, 0.16 - miss * miss));
            // Rays meet surfaces in 32-bit floats.
            if (std::abs(miss - 0.4) < 1e-3 || std::abs(v[9][i] - entry) < 1e-3) continue;
            const bool behind = miss < 0.4 && v[9][i] > entry;
            EXPECT_EQ(visible[i], behind ? 0 : 1) << i;
            occluded += behind ? 1 : 0;
        }
        EXPECT_GT(occluded, 20U);
    }
}

TEST_F(PointsCommands, RaysByHand) {
    // Snell's law at the glass: sin a = 1.334 sin w; 0.05 m of air and glass before the water.
    write("flat.yaml", std::string("uwvdb: 1\ncamera: {resolution: [200, 100], intrinsics: {fx: "
                                   "100}, port: {distance: 0.02, thickness: 0.03}}") +
                           k_plane_in_water);
    write("pixels.csv", "x,y\n100,50\n175,50\n200,50\n200.001,50\nnan,50\n");
    const auto result = run({"rays", "flat.yaml", "pixels.csv"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.err, "5 pixels: 2 outside the image, 0 without a ray into the water\n");
    EXPECT_NE(result.out.find("\n200.001,50,nan,nan,nan,nan,nan,nan\nnan,50,nan,"),
              std::string::npos)
        << result.out;
    const CsvTable table(result.out.substr(0, result.out.find("200.001")), "rays");
    EXPECT_NEAR(table.numbers("origin_z")[0], 0.05, 1e-12);
    EXPECT_NEAR(table.numbers("direction_z")[0], 1, 1e-12);
    EXPECT_NEAR(table.numbers("direction_x")[1], 0.6 / 1.334, 1e-12);
    const double in_glass = 0.6 / 1.49;
    EXPECT_NEAR(table.numbers("origin_x")[1],
                0.02 * 0.75 + 0.03 * in_glass / std::sqrt(1 - in_glass * in_glass), 1e-12);
}

TEST_F(PointsCommands, FilesThreadsSizesAndCamerasOfARig) {
    std::string points = "x,y,z\n";
    for (int i = 0; i < 9000; ++i) points += std::to_string(1e-4 * i) + ",0.1,2\n";
    write("points.csv", points);
    const std::string all = output_of({"project", "scene.yaml", "points.csv", "--quiet"});
    EXPECT_EQ(output_of({"project", "scene.yaml", "points.csv", "--threads", "1"}), all);
    const auto to_file = run({"project", "scene.yaml", "points.csv", "-o", "pixels.csv"});
    EXPECT_EQ(to_file.out, "");
    EXPECT_NE(to_file.err.find("wrote pixels.csv\n"), std::string::npos);
    EXPECT_EQ(read("pixels.csv"), all);
    write("one.csv", "0,0,2\n");
    EXPECT_EQ(table_of({"project", "scene.yaml", "one.csv", "--size", "66x38"}).numbers("pixel_x"),
              std::vector<double>{33});
    EXPECT_EQ(
        table_of({"project", "scene.yaml", "one.csv", "--set", "camera.pose.position=[0.5, 0, 0]",
                  "--set", "camera.pose.look_at=[0.5, 0, 1]"})
            .text("visible"),
        std::vector<std::string>{"1"});
    write("rig.yaml", std::string(R"(uwvdb: 1
cameras:
  - {name: left, resolution: [40, 20], intrinsics: {fx: 40}}
  - {name: right, resolution: [40, 20], intrinsics: {fx: 40}, pose: {position: [0.4, 0, 0], look_at: [0.4, 0, 1], up: [0, -1, 0]}}
)") + k_plane_in_water);
    EXPECT_EQ(table_of({"project", "rig.yaml", "one.csv", "--camera", "right"}).numbers("pixel_x"),
              std::vector<double>{20 - 40 * 0.2});
    expect_failure({"project", "rig.yaml", "one.csv"}, 2, "choose one of left, right");
    expect_failure({"rays", "rig.yaml", "one.csv", "--camera", "lft"}, 2, "it has left, right");
    expect_failure({"rays", "scene.yaml", "one.csv", "--camera", "a"}, 2, "has one camera");
}

TEST_F(PointsCommands, RefuseInOneLine) {
    write("bad.csv", "x,y,z\n1,2,3\n1,2,abc\n");
    expect_failure({"project", "scene.yaml", "bad.csv"}, 3, "bad.csv:3: 'abc' in column 'z'");
    write("bad.csv", "x,y\n1,2\n1\n");
    expect_failure({"rays", "scene.yaml", "bad.csv", "-o", "rays.csv"}, 3,
                   "bad.csv:3: 1 cell where there are 2 columns");
    EXPECT_FALSE(exists("rays.csv"));
    expect_failure({"project", "scene.yaml", "bad.csv"}, 3, "bad.csv:1: the columns x, y, z");
    expect_failure({"project", "scene.yaml", "none.csv"}, 4, "none.csv: no such file");
    expect_failure({"project", "scene.yaml"}, 2, "POINTS.csv is required");
    write("points.csv", "1,2,3\n");
    expect_failure({"project", "scene.yaml", "points.csv", "-o", "points.csv"}, 4, "points.csv");
    EXPECT_EQ(read("points.csv"), "1,2,3\n");
    expect_failure({"project", "scene.yaml", "points.csv", "--set", "camera.prt=1"}, 3,
                   "did you mean 'port'?");
    expect_failure({"project", "scene.yaml", "points.csv", "--size", "0x3"}, 2,
                   "each side must be 1 to 32768 pixels");
}

TEST_F(PointsCommands, NeedVolumesAndLampsNeitherReadNorNamed) {
    write("plume.yaml", std::string(test::k_small_scene) +
                            "volumes:\n  - {file: smoke_####.vdb, grids: {density: {small: 1}}}\n");
    write("one.csv", "0,0,2\n");
    EXPECT_EQ(output_of({"project", "plume.yaml", "one.csv", "--quiet"}),
              "x,y,z,pixel_x,pixel_y,path,in_image,visible\n0,0,2,16.5,9.5,2,1,1\n");
}

}  // namespace
}  // namespace uw
