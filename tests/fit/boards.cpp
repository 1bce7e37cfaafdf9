// ctest labels: analytic
// A checkerboard seen through a port, drawn by the rays themselves, is found in its pictures, and
// the port from it.
#include "fit/board_corners.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>

#include "camera/camera.h"
#include "core/base/error.h"
#include "core/base/json.h"
#include "core/image/image_file.h"
#include "core/scene/scene_desc.h"
#include "core/scene/trajectory.h"
#include "tests/support/cli_test.h"
#include "tests/support/message_of.h"

namespace uw::test {
namespace {

constexpr const char* k_boarded_rig = R"(uwvdb: 1
camera:
  resolution: [480, 360]
  intrinsics: {fx: 420, fy: 420, cx: 240, cy: 180}
  port: {type: flat, normal: [0.06, -0.04, 1], distance: 0.03, thickness: 0.012, n_glass: 1.5, n_water: 1.334}
water: {bands: [550], absorption: [0], scattering: {b: [0], phase: {type: hg, g: 0.9}}}
lamps: [{name: l, position: [0, 0, 0.2], intensity: [1]}]
)";

constexpr int k_columns = 7, k_rows = 5;
constexpr double k_square = 0.03;

/// White around it, squares about the middle; 16 rays a pixel.
void draw_board(const Camera& camera, const Affine& camera_from_board,
                const std::filesystem::path& file, int rows = k_rows) {
    const Affine board_from_camera = camera_from_board.inverse();
    Preview picture(camera.width(), camera.height());
    for (int y = 0; y < camera.height(); ++y)
        for (int x = 0; x < camera.width(); ++x) {
            double white = 0;
            constexpr int k_side = 4;
            for (int i = 0; i < k_side * k_side; ++i) {
                const auto ray = camera.refracted_ray(x + (i % k_side + 0.5) / k_side,
                                                      y + (i / k_side + 0.5) / k_side);
                const Point3 from = board_from_camera * ray->origin;
                const Vector3 along = board_from_camera.apply_to_vector(ray->direction);
                const double s = -from.z / along.z;
                const double column = (from.x + s * along.x) / k_square + 0.5 * (k_columns + 1);
                const double row = (from.y + s * along.y) / k_square + 0.5 * (rows + 1);
                const bool is_board =
                    column >= 0 && column < k_columns + 1 && row >= 0 && row < rows + 1;
                const bool is_dark =
                    is_board && (static_cast<int>(column) + static_cast<int>(row)) % 2 == 0;
                white += is_dark ? 0.1 : 0.9;
            }
            const auto value = static_cast<std::uint8_t>(std::lround(255 * white / 16));
            picture(x, y) = {value, value, value};
        }
    write_png(file, picture, {});
}

class FitBoards : public CliTest {};

TEST_F(FitBoards, AreFoundAndThePortFromThem) {
    const Camera camera(read_scene_text(k_boarded_rig, "rig.yaml").camera);
    const TempDir folder;
    for (int image = 0; image < 5; ++image) {
        const Vector3 turn{0.35 * std::sin(2.1 * image + 1), 0.35 * std::cos(1.3 * image),
                           0.1 * image};
        const Affine camera_from_board(
            rotation_by(turn).matrix(),
            {0.05 * std::cos(2.5 * image), 0.04 * std::sin(1.9 * image), 0.42 + 0.05 * image});
        draw_board(camera, camera_from_board, folder / ("board_" + std::to_string(image) + ".png"));
    }
    write_png(folder / "board_5.png", Preview(480, 360), {});  // nothing to see
    write("rig.yaml", k_boarded_rig);
    const ProgramResult result =
        run({"fit", "rig.yaml", "--images", (folder / "board_%d.png").string(), "--board",
             "7x5x0.03", "--corners", "corners.csv", "--unknown",
             "camera.port.distance,camera.port.normal", "--set", "camera.port.normal=[0, 0, 1]",
             "--set", "camera.port.distance=0.015", "--json", "--quiet"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.err.find("board_5.png: the board of 7 x 5 corners is not to be seen"),
              std::string::npos);
    const Json found = Json::parse(result.out);
    EXPECT_EQ(found.at("observations"), 5 * k_columns * k_rows);
    // A tenth of a pixel is what corners are found to where squares are 25 pixels wide.
    EXPECT_LT(found.at("rms").get<double>(), 0.1);
    const Json& distance = found.at("unknowns")[0];
    EXPECT_NEAR(distance.at("value").get<double>(), 0.03, 4 * distance.at("error").get<double>());
    EXPECT_LT(distance.at("error").get<double>(), 0.004);
    const Json& tilt = found.at("unknowns")[1];
    EXPECT_NEAR(tilt.at("value").get<double>(), std::atan(0.06) * 180 / 3.14159265358979,
                4 * tilt.at("error").get<double>());

    // Where the camera was, with errors: in the board's axes, some 0.4 m before it.
    for (const Json& image : found.at("images")) {
        EXPECT_NEAR(std::abs(image.at("position")[2].get<double>()), 0.5, 0.2) << image.dump();
        for (const char* const key : {"position_error", "turn_error"})
            for (const Json& error : image.at(key)) {
                EXPECT_GT(error.get<double>(), 0) << image.dump();
                // A centimetre, a degree.
                EXPECT_LT(error.get<double>(), key[0] == 'p' ? 0.01 : 1) << image.dump();
            }
    }

    // The table of corners serves as well.
    const ProgramResult again =
        run({"fit", "rig.yaml", "--points", "corners.csv", "--unknown", "camera.port.distance",
             "--found-poses", "poses.json", "--report", "fit.html"});
    EXPECT_EQ(again.exit_code, 0) << again.err;
    EXPECT_NE(again.out.find("The camera's poses are known to "), std::string::npos) << again.out;
    EXPECT_NE(read("fit.html").find("Where the camera was"), std::string::npos);
    for (const Json& frame : Json::parse(read("poses.json")).at("frames"))
        EXPECT_EQ(frame.at("position_error").size(), 3U);
    EXPECT_EQ(run({"fit", "rig.yaml", "--points", "corners.csv", "--unknown",
                   "camera.port.distance", "--found-poses", "poses.csv"})
                  .exit_code,
              0);
    EXPECT_EQ(read("poses.csv").find("image,x,y,z,x_error,y_error,z_error,turn_x_error"), 0U);
    EXPECT_EQ(line_count(read("poses.csv")), 6);

    // What the table's numbers are stands where they are asked for.
    const ProgramResult help = run({"fit", "--help"});
    EXPECT_NE(help.out.find("the first pixel's centre\n(0.5, 0.5), u to the right, v down"),
              std::string::npos);
}

// Held upside down, too: a board of 7 x 5 corners looks the same turned by half, but one of 7 x 4
// has a black square at one end alone.
TEST_F(FitBoards, BeginAtTheirBlackCorner) {
    const Camera camera(read_scene_text(k_boarded_rig, "rig.yaml").camera);
    const TempDir folder;
    constexpr int k_fewer_rows = 4;
    for (const double turn : {0.1, 0.1 + 3.14159265358979}) {
        const Affine camera_from_board(rotation_by({0.2, 0.1, turn}).matrix(), {0.01, 0.02, 0.45});
        const std::filesystem::path picture = folder / (turn < 1 ? "upright.png" : "turned.png");
        draw_board(camera, camera_from_board, picture, k_fewer_rows);
        const PointTable found = find_board_corners({picture}, {k_columns, k_fewer_rows, k_square},
                                                    [](const std::string&) {});
        ASSERT_EQ(found.points.size(), std::size_t{k_columns} * k_fewer_rows);
        for (const PhotographedPoint& point : found.points) {
            // The picture's squares are about the middle.
            const Vector3 from_middle =
                from_origin(point.point) -
                0.5 * k_square * Vector3(k_columns - 1, k_fewer_rows - 1, 0);
            const auto seen = camera.project(camera_from_board * at_origin_plus(from_middle));
            EXPECT_LT(std::hypot(seen->x - point.seen.x, seen->y - point.seen.y), 0.3) << turn;
        }
    }
}

TEST_F(FitBoards, OfOtherFormsAreRefused) {
    EXPECT_EQ(
        message_of<UsageError>([] { read_board("9x6"); }),
        "--board 9x6: give COLUMNSxROWSxSIDE, its inner corners (at least 3 x 3) and the side "
        "of a square in metres, such as 9x6x0.03");
    for (const char* const text : {"2x6x0.03", "9x6x0", "9.5x6x0.03", "x", "9x6x0.03m", "9x6x-1"})
        EXPECT_THROW(read_board(text), UsageError) << text;
}

}  // namespace
}  // namespace uw::test
