// ctest labels: unit metamorphic
// The image of a camera with a sensor, as `uwvdb render` writes it.
#include <gtest/gtest.h>

#include "core/image/image_file.h"
#include "tests/support/cli_test.h"

namespace uw {
namespace {

class SensorImages : public test::CliTest {
  protected:
    SensorImages() {
        std::string scene = test::k_small_scene;
        scene.insert(scene.find("  pose:"),
                     "  lens: {f_number: 2.8, focal_length: 0.0085}\n"
                     "  sensor: {exposure: 0.002, pixel_pitch: 3.45e-6, mosaic: rggb,\n"
                     "    quantum_efficiency: [0.4, 0.6, 0.5], full_well: 10500,\n"
                     "    read_noise: 2.4, black_level: 60, bit_depth: 12}\n");
        write("camera.yaml", scene);
    }
    void expect_runs(const std::vector<std::string>& more) const {
        std::vector<std::string> arguments{"render", "camera.yaml"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const test::ProgramResult result = run(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
    }
    PixelImage picture(const std::string& name) const { return read_image(folder_ / name); }

    const std::string developed_ =
        "camera.sensor.image={white_balance: grey-world, response: srgb}";
};

TEST_F(SensorImages, StandBesideTheOthersAndHoldTheNumbersOfTheLayer) {
    expect_runs({"-o", "out.exr", "--layers", "sensor", "--threads", "1"});
    EXPECT_TRUE(exists("out.png"));
    const test::ImageFile exr = test::read_exr(folder_ / "out.exr");
    const PixelImage raw = picture("out.sensor.png");
    ASSERT_EQ(raw.channels, 1);
    ASSERT_EQ(raw.pixels.size(), 33U * 19U);
    int above_black = 0;
    for (int y = 0; y < 19; ++y)
        for (int x = 0; x < 33; ++x) {
            const float number = exr.at("sensor.V", x, y);
            above_black += number > 80 ? 1 : 0;
            EXPECT_EQ(raw.pixels[static_cast<std::size_t>(33 * y + x)], 16 * number / 65535);
        }
    EXPECT_GT(above_black, 300);
    EXPECT_EQ(exr.metadata.at("uwvdb/sensor_mosaic"), "rggb");
    // Without the layer the EXR is as it would be without a sensor.
    expect_runs({"-o", "plain.exr", "--threads", "2"});
    EXPECT_EQ(test::read_exr(folder_ / "plain.exr").channels.count("sensor.V"), 0U);
    EXPECT_EQ(read("plain.sensor.png"), read("out.sensor.png"));
}

TEST_F(SensorImages, AreAllThatIsWrittenIfTheyAreRequested) {
    expect_runs({"-o", "a.sensor.png", "--set", developed_});
    EXPECT_FALSE(exists("a.png"));
    EXPECT_FALSE(exists("a.exr"));
    EXPECT_EQ(picture("a.sensor.png").channels, 3);
    const std::size_t before = file_count();
    expect_runs({"-o", "a.jpg", "--set", developed_, "--set", "camera.sensor.image.format=jpeg",
                 "--contact-sheet", "sheet.png"});
    EXPECT_EQ(file_count(), before + 2);
    const PixelImage png = picture("a.sensor.png"), jpeg = picture("a.jpg");
    ASSERT_EQ(jpeg.pixels.size(), png.pixels.size());
    double sum = 0;
    for (std::size_t i = 0; i < png.pixels.size(); ++i)
        sum += std::abs(static_cast<double>(png.pixels[i] - jpeg.pixels[i]));
    EXPECT_LT(sum / static_cast<double>(png.pixels.size()), 0.04);  // noise is costly to store
}

// An exposure far too long: each well is full. It is told of raw numbers and of what
// is developed from them, and not of a picture that shows something.
TEST_F(SensorImages, SayThatTheyAreSaturatedAllOver) {
    const std::string longer = "camera.sensor.exposure=1000";
    const auto warned = [&](const std::vector<std::string>& more) {
        std::vector<std::string> arguments{"render", "camera.yaml", "-o", "out.exr"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const test::ProgramResult result = run(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        const std::size_t at = result.err.find("every pixel of the image is saturated");
        if (at != std::string::npos) {
            EXPECT_NE(result.err.find("make the exposure shorter than 1000 s, or the lamps dimmer"),
                      std::string::npos)
                << result.err;
        }
        return at != std::string::npos;
    };
    EXPECT_FALSE(warned({}));
    EXPECT_TRUE(warned({"--set", longer}));
    EXPECT_TRUE(warned({"--set", longer, "--set", developed_}));
    // Numbers end at the converter's white, or at the full well below it.
    EXPECT_TRUE(warned({"--set", longer, "--set", "camera.sensor.gain=0.1"}));
    EXPECT_FALSE(warned({"--set", developed_}));
}

TEST_F(SensorImages, OfACropAreThoseOfTheWhole) {
    // Grey-world gains are each image's own.
    const std::string set = "camera.sensor.image={white_balance: [1.5, 1, 1.2], response: srgb}";
    expect_runs({"-o", "whole.exr", "--set", set, "--numbers", "whole.csv"});
    expect_runs({"-o", "part.exr", "--set", set, "--crop", "7,4,20,15", "--numbers", "part.csv"});
    const PixelImage whole = picture("whole.sensor.png"), part = picture("part.sensor.png");
    ASSERT_EQ(part.width, 13);
    ASSERT_EQ(part.height, 11);
    for (int y = 0; y < 11; ++y)
        for (int x = 0; x < 13; ++x)
            for (int c = 0; c < 3; ++c)
                EXPECT_EQ(part.pixels[static_cast<std::size_t>((y * 13 + x) * 3 + c)],
                          whole.pixels[static_cast<std::size_t>(((y + 4) * 33 + x + 7) * 3 + c)]);
    const test::ImageFile exr = test::read_exr(folder_ / "part.exr");
    EXPECT_EQ(exr.x, 7);
    EXPECT_EQ(exr.width, 13);
    EXPECT_EQ(exr.height, 11);
}

TEST_F(SensorImages, OfFramesHaveNoiseOfTheirOwnAndAreResumed) {
    const test::ProgramResult result =
        run({"render", "camera.yaml", "-o", "f.##.exr", "--frames", "1-2"});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(result.err.find("all frames are alike"), std::string::npos) << result.err;
    const std::string first = read("f.01.sensor.png"), second = read("f.02.sensor.png");
    EXPECT_NE(picture("f.01.sensor.png").pixels, picture("f.02.sensor.png").pixels);
    std::filesystem::remove(folder_ / "f.02.sensor.png");
    const auto written = std::filesystem::last_write_time(folder_ / "f.01.exr");
    expect_runs({"-o", "f.##.exr", "--frames", "1-2", "--resume"});
    EXPECT_EQ(read("f.02.sensor.png"), second);
    EXPECT_EQ(read("f.01.sensor.png"), first);
    EXPECT_EQ(std::filesystem::last_write_time(folder_ / "f.01.exr"), written);
}

TEST_F(SensorImages, OfARigAreNamedByTheirCameras) {
    std::string scene = read("camera.yaml");
    const std::size_t begin = scene.find("camera:\n"), end = scene.find("water:");
    const std::string camera = scene.substr(begin + 8, end - begin - 8);
    std::string rig = "cameras:\n";
    for (const char* name : {"left", "right"}) {
        std::string entry = camera;
        for (std::size_t at = 0; (at = entry.find("\n  ", at)) != std::string::npos; at += 5)
            entry.replace(at, 3, "\n    ");
        rig += "  - name: " + std::string(name) + "\n  " + entry;
    }
    write("camera.yaml", scene.replace(begin, end - begin, rig));
    expect_runs({"-o", "out.exr"});
    EXPECT_NE(picture("out.left.sensor.png").pixels, picture("out.right.sensor.png").pixels);
    expect_runs({"-o", "only.sensor.png"});
    EXPECT_EQ(picture("only.left.sensor.png").pixels, picture("out.left.sensor.png").pixels);
    EXPECT_TRUE(exists("only.right.sensor.png"));
}

TEST_F(SensorImages, ThatCannotBeAreRefused) {
    expect_failure({"render", "scene.yaml", "-o", "a.sensor.png"}, 2, "the camera has no sensor");
    expect_failure({"render", "scene.yaml", "--layers", "sensor"}, 2, "add camera.sensor");
    expect_failure({"render", "camera.yaml", "-o", "a.jpg"}, 2, "the camera's image is a PNG");
    expect_failure({"render", "camera.yaml", "-o", "a.sensor.png", "--layers", "depth"}, 2,
                   "--layers: is for the EXR, but -o a.sensor.png is the camera's image alone");
    expect_failure({"render", "camera.yaml", "-o", "a.sensor.png", "--set",
                    "camera.sensor.image={format: jpeg}"},
                   2, "the camera's image is a JPEG");
    EXPECT_EQ(file_count(), 2U);
}

}  // namespace
}  // namespace uw
