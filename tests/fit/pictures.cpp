// ctest labels: metamorphic
// Water and lamps from pictures that were rendered with others.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/json.h"
#include "core/image/colour.h"
#include "core/image/image_file.h"
#include "core/scene/trajectory.h"
#include "render/scene_loading.h"
#include "tests/support/fit_pictures.h"

namespace uw::test {
namespace {

// Cells of five pixels stand for their middle: what light does within them to second order is
// left, and b and a make up for each other's errors.
TEST_F(FitPictures, WaterAndBrightnessFromLight) {
    take_pictures("");
    const Json found =
        fit("dive_%02d.exr", "water.absorption,water.scattering.b,lamps.*.intensity",
            {"water.absorption=[0.4, 0.2, 0.1]", "water.scattering.b=[0.15, 0.2, 0.2]",
             "lamps.left.intensity=[40, 40, 40]", "lamps.right.intensity=[40, 40, 40]"});
    EXPECT_TRUE(found.at("converged").get<bool>());
    EXPECT_LT(found.at("relative_rms").get<double>(), 1e-3);
    expect_found(found,
                 {{"water.absorption[0]", 0.25},
                  {"water.absorption[1]", 0.09},
                  {"water.absorption[2]", 0.05},
                  {"water.scattering.b[0]", 0.30},
                  {"water.scattering.b[1]", 0.32},
                  {"water.scattering.b[2]", 0.35},
                  {"lamps.left.intensity[0]", 30},
                  {"lamps.right.intensity[2]", 24}},
                 0, 0.003);
    const std::string page = read("fit.html");
    EXPECT_NE(page.find("Fit of dive.yaml"), std::string::npos);
    EXPECT_NE(page.find("data:image/png"), std::string::npos);  // seen, predicted and difference
}

TEST_F(FitPictures, GainAndBrightnessCannotBeToldApart) {
    take_pictures(k_raw_sensor);
    const Json found = fit("dive_%02d.sensor.png", "camera.sensor.gain,lamps.*.intensity", {});
    const auto& doubts = found.at("doubts");
    ASSERT_FALSE(doubts.empty());
    const std::string first = doubts[0].get<std::string>();
    EXPECT_NE(first.find("camera.sensor.gain"), std::string::npos) << first;
    EXPECT_NE(first.find("lamps.left.intensity[0]"), std::string::npos) << first;
    EXPECT_NE(first.find("cannot be told apart"), std::string::npos) << first;
}

// As a camera develops them: each picture with an exposure of its own, a curve that is not sRGB's,
// 8 bits. The power of a cell's mean is not the mean of the powers, and rounding is what is off
// besides.
TEST_F(FitPictures, ExposuresAndResponseOfDevelopedPictures) {
    take_pictures("");
    constexpr double k_exposures[] = {0.5, 0.9, 0.35}, k_response = 0.85;
    for (int frame = 0; frame < 3; ++frame) {
        const PixelImage light = read_linear_image(folder_ / fmt::format("dive_{:02}.exr", frame));
        Preview developed(light.width, light.height);
        for (int y = 0; y < light.height; ++y)
            for (int x = 0; x < light.width; ++x)
                for (std::size_t k = 0; k < 3; ++k) {
                    const auto index =
                        static_cast<std::size_t>((y * light.width + x) * light.channels) + k;
                    const double exposed = k_exposures[frame] * double{light.pixels[index]};
                    developed(x, y)[k] = static_cast<std::uint8_t>(std::lround(
                        255 * srgb_encode(std::clamp(std::pow(exposed, k_response), 0.0, 1.0))));
                }
        write_png(folder_ / fmt::format("dive_{:02}.png", frame), developed, {});
    }
    const Json found = fit("dive_%02d.png", "water.absorption,exposure,response",
                           {"water.absorption=[0.35, 0.15, 0.1]"});
    EXPECT_TRUE(found.at("converged").get<bool>());
    expect_found(found,
                 {{"water.absorption[0]", 0.25},
                  {"water.absorption[1]", 0.09},
                  {"water.absorption[2]", 0.05},
                  {"exposure[0] (dive_00.png)", 0.5},
                  {"exposure[1] (dive_01.png)", 0.9},
                  {"exposure[2] (dive_02.png)", 0.35},
                  {"response", k_response}},
                 4, 0.015);
    for (const Json& unknown : found.at("unknowns"))
        EXPECT_LT(unknown.at("error").get<double>(), 0.02) << unknown.dump();
}

// A lamp twice as bright is an exposure twice as long.
TEST_F(FitPictures, ExposuresAndBrightnessCannotBeToldApart) {
    take_pictures(k_raw_sensor);
    const Json found = fit("dive_%02d.sensor.png", "exposure,lamps.*.intensity", {});
    ASSERT_FALSE(found.at("doubts").empty());
    const std::string first = found.at("doubts")[0].get<std::string>();
    for (const char* const name :
         {"exposure[0] (dive_00.sensor.png)", "exposure[2] (dive_02.sensor.png)",
          "lamps.left.intensity[0]", "lamps.right.intensity[2]", "cannot be told apart"})
        EXPECT_NE(first.find(name), std::string::npos) << first;
    // With that of one picture known, all are.
    const Json of_two = fit("dive_%02d.sensor.png", "exposure,lamps.*.intensity", {},
                            {"--prior", "exposure[0]=1+-0.001"});
    EXPECT_TRUE(of_two.at("doubts").empty() ||
                of_two.at("doubts")[0].get<std::string>().find("told apart") == std::string::npos)
        << of_two.at("doubts").dump();
    expect_found(of_two, {{"exposure[1] (dive_01.sensor.png)", 1}, {"lamps.left.intensity[1]", 32}},
                 4, 0);
}

/// A COLMAP model in the scene's axes, at half the scale: k_dive's keyframes, of which it has not
/// registered the second, and a picture that is not there.
std::string colmap_model(const SceneDesc& scene) {
    std::string text = "# IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, CAMERA_ID, NAME\n";
    for (const int frame : {0, 2, 7}) {
        const Affine world_from_camera =
            scene.camera.trajectory->trajectory->at(std::min(frame, 2)).affine();
        const Pose pose = pose_of(world_from_camera.inverse());
        const Rotation& q = pose.rotation;
        text += fmt::format(
            "{} {:.12g} {:.12g} {:.12g} {:.12g} {:.12g} {:.12g} {:.12g} 1 "
            "dive_{:02}.exr\n\n",
            frame + 1, q.w, q.x, q.y, q.z, 0.5 * pose.position.x, 0.5 * pose.position.y,
            0.5 * pose.position.z, frame);
    }
    return text;
}

// The camera's poses and the pictures' names from COLMAP, and the scale of its world as one of the
// unknowns. The scene's own poses are elsewhere.
TEST_F(FitPictures, ByPosesOfNames) {
    take_pictures("");
    const std::string dive = read("dive.yaml");
    std::filesystem::create_directories(folder_ / "model");
    write("model/images.txt", colmap_model(load_scene(folder_ / "dive.yaml", {})));
    std::string text = dive;
    const std::size_t begin = text.find("  trajectory:"), end = text.find("\nwater:") + 1;
    text.replace(begin, end - begin,
                 "  trajectory: {file: model/images.txt, transform: {scale: 2.2}}\n");
    write("dive.yaml", text);
    const auto fitted = [&](const std::string& images, const std::string& unknown) {
        return run({"fit", "dive.yaml", "--images", images, "--poses", "model", "--unknown",
                    unknown, "--cells", "12", "--json"});
    };
    const ProgramResult of_folder = fitted(".", "camera.trajectory.transform.scale");
    ASSERT_EQ(of_folder.exit_code, 0) << of_folder.err;
    EXPECT_NE(of_folder.err.find("has none of 1 picture that --poses names"), std::string::npos)
        << of_folder.err;
    const Json found = Json::parse(of_folder.out);
    EXPECT_EQ(found.at("images").size(), 2U);
    // Cells of 13 pixels stand for their middle: what light does within them to second order.
    expect_found(found, {{"camera.trajectory.transform.scale", 2}}, 0, 0.01);

    text.replace(text.find("2.2"), 3, "2");
    write("dive.yaml", text);
    const ProgramResult of_frames = fitted("dive_%02d.exr", "lamps.left.intensity");
    ASSERT_EQ(of_frames.exit_code, 0) << of_frames.err;
    EXPECT_NE(of_frames.err.find("dive_01.exr: --poses has no pose of it; passed over"),
              std::string::npos)
        << of_frames.err;
    expect_found(Json::parse(of_frames.out), {{"lamps.left.intensity[1]", 32}}, 0, 0.01);

    EXPECT_NE(fitted("fit_%02d.exr", "water.absorption").err.find("there is no such picture"),
              std::string::npos);
    write("model/images.txt", "1 1 0 0 0 0 0 0 1 other.png\n\n");
    EXPECT_NE(fitted(".", "water.absorption")
                  .err.find("--poses: none of its 1 pose is of a picture of .; the names "
                            "must agree, as in 'other.png'"),
              std::string::npos);
}

TEST_F(FitPictures, RefusesWhatIsNotThePictureOfTheScene) {
    take_pictures("");
    const auto error = [&](const std::vector<std::string>& more) {
        std::vector<std::string> arguments{"fit", "dive.yaml", "--unknown", "water.absorption"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const ProgramResult result = run(arguments);
        EXPECT_NE(result.exit_code, 0);
        return result.err;
    };
    EXPECT_EQ(error({}),
              "uwvdb: give either --points, a table of corners, or --images, photographs\n");
    EXPECT_EQ(error({"--images", "none_%02d.exr"}),
              "uwvdb: none_%02d.exr: there is no such picture for any frame; check the name\n");
    EXPECT_NE(error({"--images", "dive_%02d.exr", "--set", "camera.resolution=[80, 60]"})
                  .find("is 160 x 120 pixels, and the scene's camera 80 x 60; set "
                        "camera.resolution and camera.intrinsics to the picture's"),
              std::string::npos);
    EXPECT_NE(error({"--points", "corners.csv", "--unknown", "exposure"})
                  .find("--unknown exposure: is that of pictures"),
              std::string::npos);
    EXPECT_NE(error({"--images", "dive_%02d.exr", "--prior", "water.absorption=1"})
                  .find("give KEY=VALUE+-ERROR"),
              std::string::npos);
}

}  // namespace
}  // namespace uw::test
