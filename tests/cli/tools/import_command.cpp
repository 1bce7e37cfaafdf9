// ctest labels: unit analytic
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/base/json.h"
#include "core/base/vector_math.h"
#include "core/geometry/texture.h"
#include "core/image/colour.h"
#include "tests/support/cli_test.h"

namespace uw::test {
namespace {

constexpr int k_width = 48, k_height = 36;
constexpr double k_focal = 40, k_cx = 22.5, k_cy = 18;  // from the first pixel's centre

/// A slanted wall, a board in front of it, and a hole in the depths.
double depth_at(int x, int y) {
    if (x >= 34 && x < 39 && y >= 5 && y < 9) return 0;
    if (x >= 12 && x < 24 && y >= 10 && y < 22) return 1.2;
    return 2 / (1 + 0.2 * (x - k_cx) / k_focal + 0.1 * (y - k_cy) / k_focal);
}

/// The values of 16 bits that `stored` makes of the depths, 0 staying 0.
std::vector<int> depth_values(const std::function<double(double z, int x, int y)>& stored) {
    std::vector<int> values;
    for (int y = 0; y < k_height; ++y)
        for (int x = 0; x < k_width; ++x) {
            const double z = depth_at(x, y);
            values.push_back(z > 0 ? static_cast<int>(std::lround(stored(z, x, y))) : 0);
        }
    return values;
}

/// Colours that differ from pixel to pixel by about all that they can.
std::vector<int> picture_values() {
    std::vector<int> values;
    for (int i = 0; i < 3 * k_width * k_height; ++i) values.push_back((i * 7919 + 31) % 256);
    return values;
}

constexpr double k_tum_scale = 5000;

class ImportRgbd : public CliTest {
  protected:
    ImportRgbd() {
        write("rgb.png", encoded_image("png", k_width, k_height, 3, picture_values()));
        write("depth.png",
              encoded_image("png", k_width, k_height, 1,
                            depth_values([](double z, int, int) { return z * k_tum_scale; }), 16));
    }

    ProgramResult import_pair(const std::vector<std::string>& more) const {
        std::vector<std::string> arguments{"import",       "rgbd",          "--image", "rgb.png",
                                           "--intrinsics", "40,40,22.5,18", "-o",      "room.yaml"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run(arguments);
    }

    /// Renders what was imported, without water and, since that is quicker, in light reflected
    /// once.
    ImageFile render_dry(const std::string& layers, const std::string& warning = "") const {
        const ProgramResult result =
            run({"render", "room.yaml", "-o", "room.exr", "--layers", layers, "--precision",
                 "float", "--set", "water.absorption=0", "--set",
                 "water.scattering={b: 0, phase: {type: hg, g: 0}}", "--set",
                 "render.scattering=single", "--quiet"});
        EXPECT_EQ(result.exit_code, 0) << result.err;
        EXPECT_NE(result.err.find(warning), std::string::npos) << result.err;
        EXPECT_EQ(result.err.empty(), warning.empty()) << result.err;
        return read_exr(folder_ / "room.exr");
    }

    /// Expects the depths of `image` at every pixel of the pair to be right to `tolerance` [m].
    static void expect_depths(const ImageFile& image, double tolerance) {
        for (int y = 0; y < k_height; ++y)
            for (int x = 0; x < k_width; ++x)
                ASSERT_NEAR(image.at("depth.Z", x, y), depth_at(x, y), tolerance) << x << ", " << y;
    }

    /// Expects three channels of `image`, divided by those of `light`, to be the picture wherever
    /// there is depth, to one of 255 sRGB code values.
    static void expect_picture(const ImageFile& image, const std::string& layer,
                               const std::string& light = "") {
        const std::vector<int> picture = picture_values();
        for (int y = 0; y < k_height; ++y)
            for (int x = 0; x < k_width; ++x)
                for (int c = 0; c < 3; ++c) {
                    if (depth_at(x, y) == 0) continue;
                    const std::string channel(1, "RGB"[c]);
                    double value = image.at(layer + channel, x, y);
                    if (!light.empty()) value /= image.at(light + channel, x, y);
                    const int code = picture[static_cast<std::size_t>((y * k_width + x) * 3 + c)];
                    ASSERT_NEAR(255 * srgb_encode(value), code, 1) << x << ", " << y << channel;
                }
    }
};

TEST_F(ImportRgbd, GivesBackThePictureAndItsDepths) {
    const ProgramResult result = import_pair({"--depth", "depth.png", "--depth-scale", "tum"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    // 12 pixels along each side of the board.
    EXPECT_NE(result.err.find("cut along 48 pixels; 1 hole, 1.16 % of the pixels, the largest "
                              "5 x 4 at (34, 5)"),
              std::string::npos)
        << result.err;
    const ImageFile image = render_dry("albedo,depth,normal,exitance,irradiance,id");
    // Depths are stored in 0.2 mm, and the wall's pixels are its vertices.
    expect_depths(image, 0.5 / k_tum_scale + 1e-6);
    expect_picture(image, "albedo.");
    // In any light: what the surface reflects of the light that falls on it.
    expect_picture(image, "exitance.", "irradiance.");
    for (int y = 0; y < k_height; ++y)
        for (int x = 0; x < k_width; ++x)
            ASSERT_EQ(image.at("id.V", x, y), depth_at(x, y) > 0 ? 1 : 0) << x << ", " << y;
    // The wall's normal, in the scene's axes: y up, the camera looks along -z. Normals are averaged
    // over 7 x 7 pixels 5 cm apart, whose depths are rounded to 0.2 mm.
    const Vector3 wall = glm::normalize(Vector3(-0.2, 0.1, 1));
    for (const auto& [x, y] : {std::pair(3, 3), {30, 30}, {44, 18}, {27, 15}}) {
        const Vector3 normal(image.at("normal.X", x, y), image.at("normal.Y", x, y),
                             image.at("normal.Z", x, y));
        EXPECT_LT(angle_between(normal, wall), 2e-3) << x << ", " << y;
    }
}

TEST_F(ImportRgbd, ShowsEmittedColoursAsTheyAre) {
    const ProgramResult result =
        import_pair({"--depth", "depth.png", "--depth-scale", "tum", "--colours", "emission",
                     "--set", "render.scattering=single", "--quiet"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.err, "");
    expect_picture(render_dry("default", "there are no lamps"), "");
    // What the formulas of vision do to a picture: J exp(-c d) along each ray, nothing scattered.
    const ProgramResult wet =
        run({"render", "room.yaml", "-o", "wet.exr", "--layers", "default,range", "--precision",
             "float", "--set", "water.absorption=[0.4, 0.1, 0.05]", "--set",
             "water.scattering={b: 0, phase: {type: hg, g: 0}}", "--quiet"});
    ASSERT_EQ(wet.exit_code, 0) << wet.err;
    const ImageFile image = read_exr(folder_ / "wet.exr");
    const std::vector<int> picture = picture_values();
    for (const auto& [x, y] : {std::pair(16, 15), {30, 30}, {3, 3}}) {
        const double j =
            linear_from_srgb(picture[static_cast<std::size_t>((y * k_width + x) * 3)] / 255.0);
        // Over a pixel of the wall the range varies by up to 1 %.
        EXPECT_NEAR(image.at("R", x, y), j * std::exp(-0.4 * image.at("range.V", x, y)), 1e-3 * j);
    }
}

TEST_F(ImportRgbd, ReadsRangesAndDisparities) {
    const auto along_ray = [](double z, int x, int y) {
        return z * std::hypot(1, (x - k_cx) / k_focal, (y - k_cy) / k_focal) * 10000;
    };
    write("range.png", encoded_image("png", k_width, k_height, 1, depth_values(along_ray), 16));
    ProgramResult result = import_pair(
        {"--depth", "range.png", "--depth-kind", "range", "--depth-scale", "10000", "--quiet"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    expect_depths(render_dry("depth"), 1e-4);
    // 0.6 m between the cameras: 12 to 20 pixels, rounded to 1/256 of one, 1/5000 of the depth.
    const auto disparity = [](double z, int, int) { return 256 * k_focal * 0.6 / z; };
    write("disparity.png", encoded_image("png", k_width, k_height, 1, depth_values(disparity), 16));
    result = import_pair({"--depth", "disparity.png", "--depth-kind", "disparity", "--depth-scale",
                          "kitti", "--baseline", "0.6", "--quiet"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    expect_depths(render_dry("depth"), 1e-3);
}

TEST_F(ImportRgbd, TakesWhatTheProgramRendered) {
    render({"--layers", "default,range"});
    for (const char* channel : {"depth.Z", "range.V"}) {
        const ProgramResult result =
            run({"import", "rgbd", "--image", "out.png", "--depth", "out.exr", "--channel", channel,
                 "--intrinsics", "scene.yaml", "-o", "room.yaml", "--quiet"});
        ASSERT_EQ(result.exit_code, 0) << result.err;
        const ImageFile first = read_exr(folder_ / "out.exr"), again = render_dry("depth");
        for (int y = 0; y < first.height; ++y)
            for (int x = 0; x < first.width; ++x)
                ASSERT_NEAR(again.at("depth.Z", x, y), first.at("depth.Z", x, y), 1e-5)
                    << x << ", " << y;
    }
}

TEST_F(ImportRgbd, MakesOneSceneOfFolders) {
    for (const char* folder : {"rgb", "depth"}) std::filesystem::create_directory(folder_ / folder);
    // Times as TUM's sequences have them; the second depth belongs to no picture.
    for (const char* name : {"rgb/10.00.png", "rgb/10.03.png"}) write(name, read("rgb.png"));
    for (const char* name : {"depth/10.005.png", "depth/10.018.png", "depth/10.031.png"})
        write(name, read("depth.png"));
    const ProgramResult result =
        run({"import", "rgbd", "--image", "rgb", "--depth", "depth", "--depth-scale", "tum",
             "--intrinsics", "40,40,22.5,18", "-o", "room.yaml", "--json"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const Json meshes = Json::parse(result.out).at("meshes");
    ASSERT_EQ(meshes.size(), 2U);
    EXPECT_EQ(meshes[0].at("depth"), "depth/10.005.png");
    EXPECT_EQ(meshes[1].at("depth"), "depth/10.031.png");
    EXPECT_EQ(meshes[1].at("pixels_without_depth"), 20);
    EXPECT_EQ(read("room.frames.csv"),
              "frame,image,depth\n0,rgb/10.00.png,depth/10.005.png\n"
              "1,rgb/10.03.png,depth/10.031.png\n");
    const ProgramResult rendered =
        run({"render", "room.yaml", "--frames", "0-1", "-o", "f.####.exr", "--size", "12x9",
             "--quality", "draft", "--quiet"});
    EXPECT_EQ(rendered.exit_code, 0) << rendered.err;
    EXPECT_TRUE(exists("f.0001.exr"));
}

TEST_F(ImportRgbd, AsksForWhatFilesDoNotSay) {
    const std::vector<std::string> pair{"import",  "rgbd",      "--image",      "rgb.png",
                                        "--depth", "depth.png", "--intrinsics", "40,40,22.5,18"};
    const auto with = [&](std::vector<std::string> arguments,
                          const std::vector<std::string>& more) {
        arguments.insert(arguments.end(), more.begin(), more.end());
        return arguments;
    };
    expect_failure(with(pair, {"--depth-kind", "z"}), 2, "--depth-scale: depth.png has whole");
    expect_failure(with(pair, {"--depth-scale", "5000"}), 2,
                   "--depth-kind: depth.png does not say");
    expect_failure(with(pair, {"--depth-scale", "256", "--depth-kind", "disparity"}), 2,
                   "--baseline: disparities need");
    expect_failure(with(pair, {"--depth-scale", "tum", "--depth-far", "0.5"}), 3,
                   "no pixel has a depth of up to 0.5 m");
    expect_failure({"import", "rgbd", "--image", "depth.png", "--depth", "rgb.png", "--depth-scale",
                    "tum", "--intrinsics", "40,40,22.5,18"},
                   3, "are --image and --depth swapped?");
    expect_failure({"import", "rgbd", "--image", "rgb.png", "--depth", "depth.png", "--depth-scale",
                    "tum", "--intrinsics", "scene.yaml"},
                   3, "the picture has 48 x 36 pixels, the camera 33 x 19");
    expect_failure(
        with(pair, {"--depth-scale", "tum", "--quiet", "--set", "water.presett=jerlov-II"}), 3,
        "did you mean 'preset'?");
    EXPECT_FALSE(exists("rgb.yaml"));
    EXPECT_FALSE(exists("rgb.glb"));
}

}  // namespace
}  // namespace uw::test
